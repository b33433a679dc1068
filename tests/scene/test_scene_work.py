"""A scene does what answers need and no more: files, boxes, questions, and what limits leave."""

from __future__ import annotations

import os
import resource
from typing import TYPE_CHECKING, Any

import pytest
from meshes.surfaces import blob
from scenes.random_scenes import CUBE, MESHES, random_scene

import obbcli.scene.all_contacts
import obbcli.scene.shapes
from obbcli import (
    Accuracy,
    Body,
    Mesh,
    MeshError,
    Motion,
    MotionError,
    ObbTree,
    Pose,
    Scene,
    SceneBody,
    SceneError,
    TreeFileError,
)
from obbcli.scene.rounds import Rounds

if TYPE_CHECKING:
    from pathlib import Path


def write_obj(path: Path, mesh: Mesh) -> Path:
    """Write a mesh file."""
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in mesh.vertices.tolist()]
    lines += ["f " + " ".join(str(k + 1) for k in row) for row in mesh.triangles.tolist()]
    path.write_text("\n".join(lines) + "\n")
    return path


@pytest.fixture
def blobs(tmp_path: Path) -> Path:
    """Return a folder of a mesh of 2,000 triangles and its tree."""
    surface = blob(2000)
    mesh = Mesh(surface.vertices, surface.faces)
    write_obj(tmp_path / "blob.obj", mesh)
    ObbTree.build(mesh).save(tmp_path / "blob.obbt")
    return tmp_path


def row(shape: Any, count: int, step: float, **motion: Any) -> dict[str, Body]:
    """Return bodies side by side, the first of which moves."""
    bodies = {f"body {k}": Body(shape, Pose(translation=[step * k, 0, 0])) for k in range(1, count)}
    return {"body 0": Body(shape, motion=Motion(**motion)), **bodies}


def test_file_is_loaded_once_however_it_is_called(
    blobs: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    loaded = []
    load_mesh = obbcli.scene.shapes.load_mesh
    monkeypatch.setattr(
        obbcli.scene.shapes,
        "load_mesh",
        lambda path, **how: loaded.append(path) or load_mesh(path, **how),
    )
    (blobs / "link.obj").symlink_to("blob.obj")
    names = [blobs / "blob.obj", str(blobs / "blob.obj"), blobs / "." / "link.obj"]
    scene = Scene({str(k): Body(name, Pose(translation=[k, 0, 0])) for k, name in enumerate(names)})

    assert len(list(scene.first_contacts())) == 3
    assert len(list(scene.first_contacts())) == 3
    assert len(loaded) == 1


def test_bodies_that_nothing_comes_near_are_known_by_their_bounds_alone(blobs: Path) -> None:
    near = row(blobs / "blob.obbt", 2, 2.5, linear_velocity=[1, 0, 0])
    far = {"far": Body(blobs / "far.obbt", Pose(translation=[0, 99, 0]), Motion(None, [1, 2, 3]))}
    (blobs / "blob.obbt").rename(blobs / "near.obbt")
    for name in ("blob.obbt", "far.obbt"):
        (blobs / name).write_bytes((blobs / "near.obbt").read_bytes())
    contacts = Scene({**near, **far}).first_contacts()

    assert len(list(contacts)) == 1

    *bodies, alone = contacts.stats.bodies
    assert (alone.triangle_count, alone.nodes_possible) == (2000, 1999)
    assert (alone.triangles_loaded, alone.nodes_built) == (0, 0)
    assert all(body.triangles_loaded > 0 for body in bodies)
    assert contacts.stats.apart_by_bounds == 2


def test_more_tree_files_than_can_be_open_are_asked_about(blobs: Path) -> None:
    data = (blobs / "blob.obbt").read_bytes()
    bodies = {}
    for k in range(64):
        (blobs / f"{k}.obbt").write_bytes(data)
        # The first two are near each other.
        bodies[str(k)] = Body(blobs / f"{k}.obbt", Pose(translation=[9 * k - 7 * (k == 1), 0, 0]))
    limits = resource.getrlimit(resource.RLIMIT_NOFILE)
    used = len(os.listdir("/dev/fd"))  # noqa: PTH208  # names of descriptors
    resource.setrlimit(resource.RLIMIT_NOFILE, (used + 16, limits[1]))
    try:
        found = list(Scene(bodies).first_contacts())
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, limits)

    assert [(one.body_a, one.body_b) for one in found] == [("0", "1")]


def test_tree_file_that_changes_meanwhile_is_refused(blobs: Path) -> None:
    tree = blobs / "blob.obbt"
    contacts = Scene(row(tree, 2, 2.5, linear_velocity=[1, 0, 0])).first_contacts()
    ObbTree.build(CUBE).save(tree)

    with pytest.raises(TreeFileError, match=r"blob\.obbt: was written to since its bounds"):
        list(contacts)


def test_trees_over_meshes_are_begun_when_they_are_needed(blobs: Path) -> None:
    shapes = {"near": blobs / "blob.obj", "far": CUBE}
    bodies = row(shapes["near"], 2, 2.5, linear_velocity=[1, 0, 0])
    bodies["far"] = Body(shapes["far"], Pose(translation=[0, 99, 0]))
    contacts = Scene(bodies).first_contacts()
    assert [body.nodes_built for body in contacts.stats.bodies] == [0, 0, 0]

    assert len(list(contacts)) == 1

    built = [body.nodes_built for body in contacts.stats.bodies]
    assert 0 < built[0] == built[1] < 1999
    assert built[2] == 0
    assert [body.triangles_loaded for body in contacts.stats.bodies] == [2000, 2000, 12]


def test_only_the_files_of_named_pairs_are_read(blobs: Path) -> None:
    bodies = row(blobs / "blob.obj", 2, 2.5, linear_velocity=[1, 0, 0])
    scene = Scene({**bodies, "lost": blobs / "lost.stl"})

    contacts = scene.first_contacts(pairs=[("body 0", "body 1")])

    assert len(list(contacts)) == 1
    assert [body.name for body in contacts.stats.bodies] == ["body 0", "body 1"]
    with pytest.raises(MeshError, match=r"lost\.stl: no such file"):
        scene.first_contacts()


def test_first_costs_little_more_than_its_pair() -> None:
    # All come near at once, and the last pair is the first to touch.
    hard = row(MESHES[0], 30, 2.5, linear_velocity=[0.5, 0, 0], angular_velocity=[9, 8, 7])
    soon = {"a": Body(CUBE, Pose(translation=[0, 40, 0]))}
    soon["b"] = Body(CUBE, Pose(translation=[2.25, 40, 0]), Motion([-1000, 0, 0]))
    spinning = {
        name: Body(body.shape, body.pose, Motion(None, [3, 2, 1])) for name, body in hard.items()
    }
    scene = Scene({**spinning, **soon}, duration=20)

    first, every = scene.first_contacts(first=True), scene.first_contacts()

    assert [(one.body_a, one.body_b) for one in first] == [("a", "b")]
    assert len(list(every)) == 1
    assert 10 * first.stats.pops < every.stats.pops
    assert first.stats.later > 10
    assert sum(first.stats[1:8]) == first.stats.pairs


def test_no_question_is_refined_beyond_the_contact_that_is_known(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    calls = []
    ask = Rounds._slice

    def recorded(self: Rounds, query: Any, pops: int, until: float) -> Any:
        answer = ask(self, query, pops, until)
        calls.append((until, answer))
        return answer

    monkeypatch.setattr(Rounds, "_slice", recorded)
    later = 0
    for seed in range(20):
        calls.clear()
        (one,) = random_scene(seed, count=40, width=16.0).first_contacts(first=True)
        known = [answer is not None and answer.time is not None for _, answer in calls]
        after = calls[known.index(True) :]
        best = after[0][1].time
        assert all(until <= best for until, _ in after[1:])
        assert one.time <= best
        later += len(after) - 1

    assert later > 0


def test_fault_of_a_pair_names_its_bodies() -> None:
    huge = Body(CUBE, motion=Motion([1e308, 0, 0], [1e300, 0, 0]))
    still = Body(CUBE, Pose(translation=[50, 0, 0]))
    scene = Scene({"quick": huge, "still": still}, duration=1e9)

    with pytest.raises(MotionError, match="quick and still: motion: "):
        list(scene.first_contacts())


@pytest.mark.parametrize(
    ("pairs", "message"),
    [
        ([("a", "bb")], "no body of the scene is called 'bb'; did you mean 'b'"),
        ([("a", "a")], "pairs: a,a: is no pair; name two bodies"),
        (["ab"], "is no pair"),
        ([("a", "b", "c")], "is no pair"),
        ([("b", "c")], "pairs: b,c: both are static"),
        ([("b", "a")], "pairs: b,a: is ignored by the scene"),
        ([], "pairs: are none"),
    ],
)
def test_pairs_that_are_none_are_refused(pairs: Any, message: str) -> None:
    bodies = [SceneBody("a", CUBE), *(SceneBody(n, CUBE, static=True) for n in ("b", "c"))]
    scene = Scene(bodies, [{"bodies": ["a", "b"]}])

    with pytest.raises(SceneError) as caught:
        scene.first_contacts(pairs=pairs)

    assert message in str(caught.value)


def test_lists_are_not_sampled() -> None:
    scene = Scene({"a": CUBE, "b": CUBE}, accuracy=Accuracy(method="sampled"))

    with pytest.raises(MotionError, match="knows the first contact alone"):
        scene.contacts()
    with pytest.raises(MotionError, match="limit: is 0"):
        Scene({"a": CUBE}).contacts(limit=0)
