"""Bodies at their first contact: what is drawn when, and where, by formulas of its own."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
import trimesh
from oracles.rigid import rigid_points

from obbcli import (
    Accuracy,
    Body,
    Mesh,
    Motion,
    ObbError,
    ObbTree,
    Pose,
    Status,
    first_contact,
)
from obbcli.questions.pair_question import duration_of
from obbcli.view.contact import contact_picture, moment_of
from obbcli.view.gltf import glb_bytes

SAMPLES = Path(__file__).resolve().parents[2] / "sample_meshes"
PIVOT = (3.0, -20.0, 5.0)
SPIN, VELOCITY = (0.3, -0.2, 1.1), (4.0, 1.0, -2.0)


def sample(name, pose=None, motion=None):
    """Return a body of a sample mesh."""
    return Body(ObbTree.build(SAMPLES / name), pose or Pose(), motion or Motion())


def drawn(bodies, ghosts=2, duration=None, accuracy=None, **options):
    """Return answer, moment and picture."""
    answer = first_contact(*bodies, duration, accuracy or Accuracy(), **options)
    moment = moment_of(bodies, answer, duration_of(duration, bodies), ghosts)
    return answer, moment, contact_picture(bodies, answer, moment, "")


def names(picture):
    return [part.name for part in picture.parts]


def loaded(picture):
    """Return the scene that the picture's GLB file holds."""
    return trimesh.load(io.BytesIO(glb_bytes(picture)), file_type="glb", process=False)


def placed(scene, name):
    """Return the vertices of a node where the scene has them."""
    transform, geometry = scene.graph[name]
    return trimesh.transform_points(scene.geometry[geometry].vertices, transform)


LINKS = (sample("chain_link_a.off"), sample("chain_link_b.ply", motion=Motion((1, 0, 0))))


def test_contact_shows_start_way_end_and_marks():
    answer, moment, picture = drawn(LINKS, duration=5.0)

    assert answer.time == moment.time == 2.0
    assert names(picture) == [
        "A at t = 2 s",
        "triangle of A",
        "outline of the triangle of A",
        "B at t = 2 s",
        "triangle of B",
        "outline of the triangle of B",
        "B at t = 0 s",
        "B at t = 0.666667 s",
        "B at t = 1.33333 s",
        "contact normal",
        "contact point",
    ]
    opacity = {part.name: getattr(part, "opacity", None) for part in picture.parts}
    assert opacity["B at t = 0 s"] < opacity["B at t = 1.33333 s"] < opacity["B at t = 2 s"] == 1


def test_separated_shows_the_end_of_the_duration_without_marks():
    answer, moment, picture = drawn(LINKS, duration=1.5)

    assert answer.status is Status.SEPARATED
    assert moment.time == 1.5
    assert names(picture) == [
        "A at t = 1.5 s",
        "B at t = 1.5 s",
        "B at t = 0 s",
        "B at t = 0.5 s",
        "B at t = 1 s",
    ]


def test_overlap_shows_the_start_alone():
    bodies = LINKS[0], Body(LINKS[1].shape, Pose(translation=(2.5, 0, 0)), Motion((1, 0, 0)))

    answer, moment, picture = drawn(bodies)

    assert answer.status is Status.OVERLAP_AT_START
    assert (moment.time, moment.ghost_times) == (0.0, [])
    assert "A at t = 0 s" in names(picture)
    assert "triangle of A" in names(picture)
    assert names(picture)[-1] == "contact point"


def test_bodies_at_rest_have_no_ghosts():
    answer, moment, picture = drawn((LINKS[0], Body(LINKS[1].shape)))

    assert answer.status is Status.SEPARATED
    assert names(picture) == ["A at t = 0 s", "B at t = 0 s"]
    assert moment.moving == []


def test_unresolved_shows_how_far_was_proven():
    bodies = (
        sample("gear.stl", motion=Motion(angular_velocity=(0, 0, 3))),
        sample("pinion.stl", motion=Motion(angular_velocity=(0, 0, -5.9))),
    )

    answer, moment, picture = drawn(bodies, 2, 2.0, Accuracy(max_iterations=3000))

    assert answer.status is Status.UNRESOLVED
    assert moment.time == answer.time_bounds[0]
    assert 0 < moment.time < 0.0568
    assert not any("contact" in name or "triangle" in name for name in names(picture))


def test_contact_of_boxes_marks_the_point_without_triangles():
    answer, moment, picture = drawn(LINKS, 2, 5.0, Accuracy(max_depth_a=3, max_depth_b=3))

    assert answer.evidence == "boxes"
    assert moment.time == answer.time < 2.0
    assert "contact point" in names(picture)
    assert not any("triangle" in name for name in names(picture))


def test_body_inside_another_marks_what_is_inside():
    bodies = sample("board.vtk", Pose(translation=(120, 0, -7))), sample("workpiece.obj")

    answer, _, picture = drawn(bodies, solid=True)

    assert answer.contained == "a"
    assert names(picture)[-1] == "contact point"
    assert not any("triangle" in name for name in names(picture))


def test_motion_through_poses_is_drawn_at_its_poses():
    poses = [Pose(), Pose(translation=(0, 0, 1)), Pose(translation=(0, 0.5, 1))]
    motion = Motion.through([0, 1, 2], poses)

    _, moment, picture = drawn((LINKS[0], Body(LINKS[1].shape, motion=motion)), ghosts=1)

    vertices = LINKS[1].shape.mesh.vertices
    b = {part.name: part.world() for part in picture.parts if part.name.startswith("B ")}
    assert moment.time == 2.0
    np.testing.assert_allclose(
        b["B at t = 2 s"], vertices + np.array((0, 0.5, 1)), rtol=0, atol=1e-12
    )
    np.testing.assert_allclose(
        b["B at t = 1 s"], vertices + np.array((0, 0, 1)), rtol=0, atol=1e-12
    )


def test_glb_has_every_body_where_the_motion_takes_it():
    pose = Pose((0.1, 0.2, -0.3), (0, 0, 60))
    bodies = (
        sample("robot_link.ply", pose, Motion(VELOCITY, SPIN, PIVOT)),
        sample("workpiece.obj", motion=Motion(VELOCITY)),
    )
    _, moment, picture = drawn(bodies, ghosts=3, duration=2.0)
    scene = loaded(picture)
    vertices = bodies[0].shape.mesh.vertices[:40]

    for time in [*moment.ghost_times, moment.time]:
        expected = rigid_points(pose.apply(vertices), VELOCITY, SPIN, PIVOT, time)
        found = placed(scene, f"A at t = {time:.6g} s")[:40]
        np.testing.assert_allclose(found, np.array(expected, float), rtol=0, atol=3e-5)
        straight = bodies[1].shape.mesh.vertices + time * np.array(VELOCITY)
        found = placed(scene, f"B at t = {time:.6g} s")
        np.testing.assert_allclose(found, straight, rtol=0, atol=3e-5)


def test_default_pivot_is_the_posed_centroid():
    motion = Motion(angular_velocity=(0, 0, np.pi / 2))
    body = sample("chain_link_a.off", Pose(translation=(0, 0, 100)), motion)
    centroid = trimesh.load(SAMPLES / "chain_link_a.off", process=False).centroid

    _, moment, picture = drawn((body, LINKS[0]), ghosts=0)

    x, y, z = (body.shape.mesh.vertices - centroid).T
    turned = np.stack([-y, x, z + 100], axis=1) + centroid
    assert moment.time == 1.0
    np.testing.assert_allclose(picture.parts[0].world(), turned, rtol=0, atol=1e-9)


def test_glb_marks_the_point_the_normal_and_the_triangles():
    answer, _, picture = drawn(LINKS, duration=5.0)
    scene = loaded(picture)
    ball, arrow = placed(scene, "contact point"), placed(scene, "contact normal")
    size = np.linalg.norm(np.ptp(np.concatenate([p.world() for p in picture.parts]), axis=0))

    np.testing.assert_allclose(ball.mean(axis=0), answer.point, rtol=0, atol=1e-3 * size)
    distances = np.linalg.norm(ball - answer.point, axis=1)
    assert 0.004 * size < distances.min() <= distances.max() < 0.02 * size
    tip = arrow[np.argmax(np.linalg.norm(arrow - answer.point, axis=1))] - answer.point
    np.testing.assert_allclose(tip / np.linalg.norm(tip), answer.normal, rtol=0, atol=1e-5)
    for name, row, body, shift in (
        ("A", answer.triangle_a, LINKS[0], (0, 0, 0)),
        ("B", answer.triangle_b, LINKS[1], (2, 0, 0)),
    ):
        mesh = body.shape.mesh
        corners = mesh.vertices[mesh.triangles[row]] + shift
        found = placed(scene, f"triangle of {name}")
        np.testing.assert_allclose(found, corners, rtol=0, atol=1e-5)
        rest = scene.geometry[f"{name} at t = 2 s"]
        assert len(rest.faces) == len(mesh.triangles) - 1


def test_glb_tells_bodies_by_color_and_ghosts_by_opacity():
    _, _, picture = drawn(LINKS, duration=5.0)
    scene = loaded(picture)

    a, b, ghost = (
        scene.geometry[name].visual.material
        for name in ("A at t = 2 s", "B at t = 2 s", "B at t = 0.666667 s")
    )

    assert a.baseColorFactor[2] > a.baseColorFactor[0]
    assert b.baseColorFactor[0] > b.baseColorFactor[2]
    assert a.alphaMode == b.alphaMode == "OPAQUE"
    assert ghost.alphaMode == "BLEND"
    assert ghost.baseColorFactor[3] < 100


@pytest.mark.parametrize("factor", [2.0**200, 2.0**-200])
def test_glb_refuses_what_float32_cannot_hold(factor):
    meshes = [Mesh(factor * b.shape.mesh.vertices, b.shape.mesh.triangles) for b in LINKS]
    bodies = tuple(Body(ObbTree.build(mesh)) for mesh in meshes)

    with pytest.raises(ObbError, match="holds numbers as float32"):
        glb_bytes(drawn(bodies)[2])


def test_glb_refuses_what_float32_is_too_coarse_for():
    far = np.array((1e7, 0, 0))
    moved = [Mesh(b.shape.mesh.vertices + far, b.shape.mesh.triangles) for b in LINKS]
    posed = [Body(b.shape, Pose(translation=far)) for b in LINKS]

    for bodies in (tuple(Body(ObbTree.build(mesh)) for mesh in moved), tuple(posed)):
        with pytest.raises(ObbError, match=r"too coarse at 1e\+07 for what is .* wide; shift it"):
            glb_bytes(drawn(bodies)[2])


def test_direction_is_one_from_which_the_contact_is_seen():
    fingers = sample("finger_left.off", motion=Motion((0, -10, 0))), sample("workpiece.obj")

    answer, _, picture = drawn(fingers)

    # Of the ways to the eye, none leads through the pin: a cylinder of radius 10 about x = 120.
    way = np.linspace(0.3, 300, 4000)[:, None] * picture.direction + answer.point
    assert not ((np.hypot(way[:, 0] - 120, way[:, 1]) < 9.9) & (way[:, 2] < 50)).any()
    # Nor through the finger, which lies beyond y = 9 from there.
    assert abs(picture.direction[1]) < 0.5
