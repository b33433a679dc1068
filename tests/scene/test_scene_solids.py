"""Scenes of solids say of every pair what its own question says, and refuse only what may hold."""

from __future__ import annotations

import pytest
from scenes.random_scenes import CUBE, MESHES, one_by_one, plain, random_scene

from obbcli import (
    Accuracy,
    Body,
    Mesh,
    MeshError,
    Motion,
    ObbTree,
    Pose,
    Scene,
    SceneBody,
    SceneError,
    collide,
)

OPEN = Mesh(CUBE.vertices, CUBE.triangles[1:])


def nested_scene(seed, **options):
    """Return a crowded scene whose bodies are of sizes 1, 3 and 20."""
    made = random_scene(seed, count=12, width=2.5, **options)
    bodies = []
    for place, body in enumerate(made.bodies):
        mesh = body.body.shape.scaled((0.15, 0.45, 3.0)[place % 3])
        moved = Body(mesh, body.body.pose, body.body.motion)
        bodies.append(SceneBody(body.name, moved, body.static, body.group))
    return Scene(bodies, made.ignore, made.duration, made.accuracy)


def answers(scene, **options):
    return [
        plain(one.body_a, one.body_b, one.contact)
        for one in scene.first_contacts(solid=True, **options)
    ]


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize(
    "options",
    [
        {},
        {"duration": 0.0},
        {"accuracy": Accuracy(clearance=0.1)},
        {"accuracy": Accuracy(method="sampled", steps=7)},
        {"accuracy": Accuracy(leaves="boxes", max_depth_b=3)},
    ],
    ids=["moving", "at rest", "clearance", "sampled", "coarse"],
)
def test_scene_of_solids_answers_what_all_pairs_answer(seed, options):
    scene = nested_scene(seed, **options)

    found = answers(scene)

    assert found == one_by_one(scene, solid=True)
    held = [one for one in scene.first_contacts(solid=True) if one.contact.contained]
    assert held
    for one in held:
        bodies = {body.name: body.body for body in scene.bodies}
        assert collide(bodies[one.body_a], bodies[one.body_b], 0.0, solid=True).collides
    # As surfaces the held ones are no contacts at t = 0.
    surfaces = [plain(one.body_a, one.body_b, one.contact) for one in scene.first_contacts()]
    assert surfaces == one_by_one(scene)


def block(mesh, place=(0, 0, 0), velocity=(0, 0, 0)):
    return Body(mesh, Pose(None, place), Motion(velocity))


def test_earliest_contact_may_be_a_body_inside_another():
    scene = Scene(
        {
            "far": block(CUBE, (9, 0, 0), (-1, 0, 0)),
            "box": block(CUBE.scaled(3)),
            "pin": block(CUBE.scaled(0.5)),
        }
    )

    (first,) = scene.first_contacts(first=True, solid=True)
    (other,) = scene.first_contacts(pairs=[("pin", "box")], solid=True)

    assert (first.body_a, first.body_b, first.contact.contained) == ("box", "pin", "b")
    assert (first.time, other.contact.contained) == (0.0, "b")
    assert list(scene.first_contacts(pairs=[("pin", "box")])) == []


def test_open_body_is_refused_by_name_where_it_may_hold_another():
    bodies = {"box": block(CUBE.scaled(3)), "cup": block(OPEN, (0.25, 0, 0))}

    with pytest.raises(MeshError, match="body 'cup': is not watertight: 3 edges do not join"):
        Scene(bodies).first_contacts(solid=True)
    assert list(Scene(bodies).first_contacts()) == []


def test_open_body_is_taken_where_boxes_are_apart_at_the_start():
    bodies = {
        "box": block(CUBE),
        "cup": block(OPEN, (5, 0, 0), (-8, 0, 0)),
        "sheet": block(OPEN, (0, 99, 0)),
    }

    (found,) = Scene(bodies).first_contacts(solid=True)

    assert (found.body_a, found.body_b, found.time) == ("box", "cup", 0.375)


def test_trees_of_files_are_asked_as_solids(tmp_path):
    ObbTree.build(CUBE.scaled(3)).save(tmp_path / "box.obbt")
    ObbTree.build(MESHES[0].scaled(0.5)).save(tmp_path / "pin.obbt")
    scene = Scene({"box": str(tmp_path / "box.obbt"), "pin": str(tmp_path / "pin.obbt")})

    (found,) = scene.first_contacts(solid=True)

    assert found.contact.contained == "b"


def test_scene_of_solids_is_asked_about_as_such_where_a_question_does_not_say():
    bodies = {"box": block(CUBE.scaled(3)), "pin": block(CUBE.scaled(0.5))}
    solids, surfaces = Scene(bodies, solid=True), Scene(bodies)

    assert (solids.solid, surfaces.solid) == (True, False)
    assert [one.contact.contained for one in solids.first_contacts()] == ["b"]
    assert list(solids.first_contacts()) == list(surfaces.first_contacts(solid=True))
    assert list(solids.first_contacts(solid=False)) == list(surfaces.first_contacts()) == []
    with pytest.raises(SceneError, match="solid: is 1; use True or False"):
        Scene(bodies, solid=1)


def test_triangles_of_solids_are_listed_as_of_surfaces_alone():
    bodies = {"box": block(CUBE), "pin": block(CUBE.scaled(0.5), (0.75, 0, 0))}
    solids, surfaces = Scene(bodies, solid=True), Scene(bodies)

    for refused in (solids.contacts, lambda: surfaces.contacts(solid=True)):
        with pytest.raises(SceneError, match="solid: asks about solids, and a body inside another"):
            refused()
    assert list(solids.contacts(solid=False)) == list(surfaces.contacts())
    assert list(surfaces.contacts())
