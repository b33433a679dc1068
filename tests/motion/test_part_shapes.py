"""A `Part` as a shape: where it stands and how a body moves it, against its mesh placed by hand."""

from __future__ import annotations

import math

import pytest
from mesh_files.gltf_files import document, glb

import obbcli
from obbcli import Body, Mesh, Motion, MotionError, ObbTree, Pose, Scene, load_parts

HALF = math.sqrt(0.5)
TURNED = {"rotation": [0.1, 0.2, HALF, 0.6701492307676521], "translation": [0.3, -5.1, 7.7]}
NODES = [
    {"name": "plain", "mesh": 0},
    {"name": "turned", "mesh": 0, **TURNED},
    {"name": "shifted", "mesh": 0, "translation": [0.1, 0.7, 1e-3]},
    {"name": "mirrored", "mesh": 0, "scale": [-1, 1, 1], "translation": [0.3, 0, 0]},
]
POSE = Pose([0.3, -1.1, 0.7], [10.1, -0.3, 0.25])


@pytest.fixture
def robot(tmp_path):
    path = tmp_path / "robot.glb"
    scenes = [{"nodes": list(range(len(NODES)))}]
    path.write_bytes(glb(document(nodes=NODES, scenes=scenes)))
    return path


def by_hand(part):
    """Return a part's mesh where its file puts it, by the contract's sums in Python's floats."""
    q, s = part.pose.rotation.tolist(), part.pose.translation.tolist()
    placed = [
        [((q[i][0] * x + q[i][1] * y) + q[i][2] * z) + s[i] for i in range(3)]
        for x, y, z in part.mesh.vertices.tolist()
    ]
    return Mesh(placed, part.mesh.triangles, unit=part.mesh.unit)


def said(answer):
    """Return all that an answer says but what it cost."""
    return {key: value for key, value in vars(answer).items() if key not in ("stats", "_cost")}


def others():
    """Return shapes to ask about, near and far."""
    mesh = Mesh([[0, 0, -1], [9, 0, -1], [0, 9, 8], [3, 3, 3]], [[0, 1, 2], [0, 1, 3]], unit="m")
    poses = Pose(), Pose([1, 0, 0], [0.5, -4, 5]), Pose(None, [9, 0, 0])
    return [Body(mesh, pose) for pose in poses]


@pytest.mark.parametrize(
    "pose", [Pose(), POSE, Pose(None, [0, 0.1, 0])], ids=["none", "both", "shift"]
)
@pytest.mark.parametrize("name", [node["name"] for node in NODES])
def test_a_body_of_a_part_is_its_placed_mesh_posed(robot, name, pose):
    part = load_parts(robot)[name]
    body, wanted = Body(part, pose), Body(by_hand(part), pose)

    for other in others():
        assert obbcli.collide(body, other).status is obbcli.collide(wanted, other).status
        if name == "mirrored" or not pose.is_identity or part.pose.is_identity:
            assert said(obbcli.distance(body, other)) == said(obbcli.distance(wanted, other))
            found, true = (obbcli.first_contact(one, other) for one in (body, wanted))
            assert said(found) == said(true)
        assert obbcli.triangle_pairs(body, other).tolist() == (
            obbcli.triangle_pairs(wanted, other).tolist()
        )


@pytest.mark.parametrize("name", [node["name"] for node in NODES])
def test_a_part_is_the_same_shape_as_its_path(robot, name):
    part, path = load_parts(robot)[name], f"{robot}#{name}"
    corners = obbcli.load_mesh(path)

    assert part.placed_mesh.vertices[part.placed_mesh.triangles].tobytes() == (
        corners.vertices[corners.triangles].tobytes()
    )
    assert part.placed_mesh.unit == "m"
    assert ObbTree.build(part).to_bytes() == ObbTree.build(part.placed_mesh).to_bytes()
    motion = Motion([0, 0, -3], [0.1, 0.2, 0], [1, 2, 3])
    for other in others():
        found = obbcli.first_contact(Body(part, POSE, motion), other)
        wanted = obbcli.first_contact(Body(path, POSE, motion), other)
        assert found.status is wanted.status
        assert found.time_bounds == wanted.time_bounds


def test_parts_that_are_not_moved_share_their_mesh(robot):
    plain, turned, *_ = load_parts(robot)

    assert Body(turned).shape is Body(plain).shape is plain.shape
    assert Body(turned, motion=Motion([1, 0, 0])).shape is plain.shape
    assert Body(turned).pose is turned.pose
    assert Body(plain, POSE).shape is plain.shape
    assert Body(plain, POSE).pose is POSE
    assert Body(turned, POSE).shape is Body(turned, Pose([0, 0, 1])).shape
    assert not turned.is_decoded


def test_poses_of_a_path_are_of_the_file_s_world(robot):
    part = load_parts(robot)["turned"]
    for first in Pose(), POSE:
        motion = Motion.through([0.0, 1.0], [first, Pose([0, 0, 1], [5, 5, 5])])
        for other in others():
            found = obbcli.first_contact(Body(part, motion=motion), other)
            wanted = obbcli.first_contact(Body(by_hand(part), motion=motion), other)
            assert said(found) == said(wanted)


def test_scenes_and_sweeps_take_parts(robot):
    part = load_parts(robot)["turned"]
    baked, other = by_hand(part), others()[0]
    motions = [Motion([0, 0, -speed]) for speed in (1, 5, 20)]

    rows = obbcli.sweep(Body(part, POSE), other, motions)
    wanted = obbcli.sweep(Body(baked, POSE), other, motions)
    found = [one.contact for one in Scene({"a": Body(part, POSE), "b": other}).first_contacts()]
    true = [one.contact for one in Scene({"a": Body(baked, POSE), "b": other}).first_contacts()]

    assert rows.tobytes() == wanted.tobytes()
    assert [said(one) for one in found] == [said(one) for one in true]
    plain = obbcli.sweep(part, other, motions)
    assert plain["status"].tolist() == obbcli.sweep(baked, other, motions)["status"].tolist()


def test_pivots_are_those_of_the_part(robot):
    part = load_parts(robot)["turned"]
    spin = Motion(angular_velocity=[0, 0, 2])
    centre = part.pose.apply(part.mesh.surface_centroid[None])[0]

    found = obbcli.first_contact(Body(part, motion=spin), others()[0], 3.0)
    wanted = obbcli.first_contact(
        Body(part, motion=Motion(None, [0, 0, 2], centre)), others()[0], 3.0
    )

    assert said(found) == said(wanted)


def test_what_is_no_shape_is_refused():
    for shape in 5, None, Body("a.stl"), [[0, 0, 0]]:
        with pytest.raises(MotionError, match="pass an ObbTree, a Mesh, a Part or a path"):
            Body(shape)
