"""Questions about surfaces at rest answer as exact arithmetic over all pairs of triangles does."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from meshes.nasty import NASTY, bumpy_grid, soup
from oracles import still as oracles
from oracles.mesh import mesh_pairs, posed
from scenes import cases
from scenes import pairs as scenes
from strategies.meshes import grids
from strategies.meshes import mesh_pairs as soup_pairs
from strategies.still import examples

import obbcli
from obbcli import Body, Mesh, ObbTree, Pose, Status

if TYPE_CHECKING:
    from pathlib import Path

FITS = ("triangles", "points", "hull", "min-volume", "axis-aligned")
SPLITS = ("median", "center", "compact")
UNTURNED = (np.eye(3), np.zeros(3))


def in_world(surface: Any, pose: Any) -> Any:
    """Return the vertices as the contract poses them: an identity rounds nothing."""
    rotation, translation = pose
    if np.array_equal(rotation, np.eye(3)) and not np.any(translation):
        return np.asarray(surface[0], dtype=np.float64)
    return posed(surface[0], rotation, translation)


def agrees(a: Any, b: Any, surfaces: Any, poses: Any = (UNTURNED, UNTURNED)) -> list[Any]:
    """Hold both questions about `a` and `b` to brute force over the surfaces; return the pairs."""
    worlds = [in_world(*both) for both in zip(surfaces, poses, strict=True)]
    truth = mesh_pairs(worlds[0], surfaces[0][1], worlds[1], surfaces[1][1])

    pairs = obbcli.triangle_pairs(a, b)
    assert pairs.dtype == np.int64
    assert [tuple(pair) for pair in pairs.tolist()] == truth
    answer = obbcli.collide(a, b)
    assert answer.status is (Status.OVERLAP_AT_START if truth else Status.SEPARATED)
    assert answer.collides == bool(truth)
    assert (answer.approximate, answer.error_bound) == (False, 0.0)
    assert answer.witness in truth if truth else answer.witness is None
    if answer.witness is not None:
        corners = [
            w[np.asarray(s[1])[i]] for w, s, i in zip(worlds, surfaces, answer.witness, strict=True)
        ]
        assert oracles.triangles_intersect(*corners)
    return truth


def body(surface: Any, pose: Any = UNTURNED, **options: Any) -> Body:
    return Body(ObbTree.build(Mesh(*surface), **options), Pose(*pose))


def centered(surface: Any, seed: int) -> Any:
    """Return a pose at random that brings the middle of a surface to the origin."""
    rotation = scenes.random_rotation(seed)
    return rotation, -rotation @ surface[0].mean(axis=0)


@given(
    surfaces=soup_pairs(), options=st.sampled_from(list(itertools.product(FITS, SPLITS, (1, 3))))
)
@examples(300)
def test_degenerate_soups_of_any_scale_meet_as_brute_force_says(
    surfaces: Any, options: Any
) -> None:
    names = ("fit", "split", "leaf_size")
    a, b = (body(s, **dict(zip(names, options, strict=True))) for s in surfaces)

    truth = agrees(a, b, surfaces)

    swapped = obbcli.triangle_pairs(b, a).tolist()
    assert sorted((i, j) for j, i in swapped) == truth


@given(a=grids(), b=grids(), shift=st.tuples(*[st.integers(-12, 12)] * 3), turn=st.integers(0, 5))
@examples(120)
def test_integer_grids_touching_and_coplanar_meet_as_brute_force_says(
    a: Any, b: Any, shift: Any, turn: int
) -> None:
    # Turned by permutations of the axes and moved by halves and quarters: contact stays exact.
    order = list(itertools.permutations(range(3)))[turn]
    rotation = np.eye(3)[list(order)]
    rotation[0] *= np.linalg.det(rotation)
    pose = (rotation, np.array(shift) / 4)

    agrees(body(a), body(b, pose), (a, b), (UNTURNED, pose))


@pytest.mark.parametrize("seed", range(25))
def test_posed_soups_meet_as_brute_force_says(seed: int) -> None:
    random = np.random.default_rng(seed)
    a, b = soup(20, seed), soup(25, seed + 100)
    poses = [(scenes.random_rotation(2 * seed + k), random.uniform(-0.5, 0.5, 3)) for k in range(2)]

    agrees(body(a, poses[0]), body(b, poses[1]), (a, b), poses)


@pytest.mark.parametrize("seed", range(8))
def test_equal_poses_still_round_the_vertices(seed: int) -> None:
    # Surfaces that touch vertex on face before they are posed need not after.
    vertices, faces = soup(15, seed)
    middles = vertices[faces].mean(axis=1)
    random = np.random.default_rng(seed)
    arms = random.normal(size=(2, 15, 3))
    spikes = np.concatenate((middles, middles + arms[0], middles + arms[1]))
    other = (spikes, np.arange(45).reshape(3, 15).T)
    pose = (scenes.random_rotation(seed), random.normal(size=3) * 10.0 ** random.integers(-3, 7))

    agrees(
        body((vertices, faces), pose), body(other, pose), ((vertices, faces), other), (pose, pose)
    )


@pytest.mark.parametrize("seed", range(10))
def test_rotations_that_are_only_nearly_orthonormal_are_taken_literally(seed: int) -> None:
    random = np.random.default_rng(seed)
    a, b = bumpy_grid(4), soup(25, seed)
    poses = []
    for k in range(2):
        skew = random.uniform(-1e-10, 1e-10, (3, 3))
        rotation, translation = centered((a, b)[k], seed + 50 * k)
        poses.append((rotation + skew, translation))

    agrees(body(a, poses[0]), body(b, poses[1]), (a, b), poses)


@pytest.mark.parametrize("exponent", [-1000, -500, 500, 1000])
@pytest.mark.parametrize("turned", [False, True])
def test_answers_do_not_depend_on_the_unit_of_length(exponent: int, turned: bool) -> None:
    a, b = soup(20, 1), soup(20, 2)
    rotation = scenes.random_rotation(1) if turned else np.eye(3)
    plain = obbcli.triangle_pairs(body(a), body(b, (rotation, np.full(3, 0.25))))
    unit = 2.0**exponent
    a, b = (a[0] * unit, a[1]), (b[0] * unit, b[1])
    pose = (rotation, np.full(3, 0.25) * unit)

    truth = agrees(body(a), body(b, pose), (a, b), (UNTURNED, pose))

    assert [tuple(pair) for pair in plain.tolist()] == truth


@pytest.mark.parametrize("exponent", [-900, -100, -50, -40, 50, 900])
@pytest.mark.parametrize("turned", [False, True])
def test_cost_does_not_depend_on_the_unit_of_length(exponent: int, turned: bool) -> None:
    pair = scenes.POSE_CLASSES["gap_1e-2"](2000)
    counts = []
    for unit in (1.0, 2.0**exponent):
        a = Mesh(pair.a.vertices * unit, pair.a.faces)
        b = Mesh((pair.b.vertices if turned else pair.posed_b) * unit, pair.b.faces)
        pose = Pose(pair.rotation, pair.translation * unit) if turned else Pose()
        counts.append(obbcli.collide(a, Body(b, pose)).stats[:4])

    assert counts[0] == counts[1]


@pytest.mark.parametrize("name", NASTY)
def test_nasty_meshes_meet_themselves_as_brute_force_says(name: str) -> None:
    surface = NASTY[name]()
    surface = (surface[0], surface[1][:60])
    tree = ObbTree.build(Mesh(*surface))

    truth = agrees(tree, tree, (surface, surface))

    assert set(truth) >= {(i, i) for i in range(len(surface[1]))}


@pytest.mark.parametrize("distance", [1e3, 1e8, 1e15])
def test_far_offsets_meet_as_brute_force_says(distance: float) -> None:
    a, b = soup(20, 3), soup(20, 4)
    poses = [
        (scenes.random_rotation(k), np.array([distance, -distance, distance / 3]) + k / 4)
        for k in range(2)
    ]

    agrees(body(a, poses[0]), body(b, poses[1]), (a, b), poses)


def test_turn_about_a_far_center_meets_as_brute_force_says() -> None:
    rotation = scenes.random_rotation(9)
    a, b = soup(20, 3), soup(20, 4)
    far = (b[0] + 1e8, b[1])
    pose = (rotation, 0.1 - rotation @ np.full(3, 1e8))

    agrees(body(a), body(far, pose), (a, far), (UNTURNED, pose))


@pytest.mark.parametrize("fits", list(itertools.product(FITS, FITS)), ids="-".join)
def test_answers_do_not_depend_on_how_trees_are_built(fits: tuple[str, str]) -> None:
    a, b = soup(40, 5), bumpy_grid(4)
    pose = centered(b, 3)
    truth = agrees(body(a), body(b, pose), (a, b), (UNTURNED, pose))
    assert truth
    options = itertools.product(SPLITS, (1, 2, 7, 64), (None, 0, 1, 4))
    for split, leaf_size, max_depth in options:
        tree_a = body(a, fit=fits[0], split=split, leaf_size=leaf_size, max_depth=max_depth)
        tree_b = body(b, pose, fit=fits[1], leaf_size=1 + leaf_size // 3, max_depth=max_depth)

        found = [tuple(pair) for pair in obbcli.triangle_pairs(tree_a, tree_b).tolist()]
        assert found == truth
        answer = obbcli.collide(tree_a, tree_b)
        assert answer.witness in truth
        assert not answer.approximate


@pytest.mark.parametrize("seed", range(3))
def test_permuted_triangles_and_vertices_meet_alike(seed: int) -> None:
    vertices, faces = soup(40, 6)
    b = body(bumpy_grid(3), centered(bumpy_grid(3), 3))
    random = np.random.default_rng(seed)
    rows, places = random.permutation(len(faces)), random.permutation(len(vertices))
    moved = Mesh(vertices[np.argsort(places)], places[faces[rows]])

    pairs = obbcli.triangle_pairs(moved, b)

    named = sorted((int(rows[i]), j) for i, j in pairs.tolist())
    assert named == [tuple(p) for p in obbcli.triangle_pairs(Mesh(vertices, faces), b).tolist()]
    assert named


def test_trees_meshes_and_paths_give_one_answer(tmp_path: Path) -> None:
    surface = bumpy_grid(5)
    mesh = Mesh(*surface)
    tree = ObbTree.build(mesh)
    tree.save(tmp_path / "sheet.obbt")
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in surface[0].tolist()]
    lines += [f"f {i + 1} {j + 1} {k + 1}" for i, j, k in surface[1].tolist()]
    (tmp_path / "sheet.obj").write_text("\n".join(lines))
    shapes = (mesh, tree, tmp_path / "sheet.obbt", str(tmp_path / "sheet.obj"))
    pose = Pose((0.1, 0.2, 0.3), (0.5, 0.25, 0.0))
    expected = obbcli.triangle_pairs(tree, Body(tree, pose))

    for a, b in itertools.product(shapes, shapes):
        assert np.array_equal(obbcli.triangle_pairs(a, Body(b, pose)), expected)
        assert obbcli.collide(Body(a), Body(b, pose)).collides


@pytest.mark.parametrize("record", cases.third_party_static(), ids=lambda record: record["id"])
def test_meshes_from_other_projects_reports_meet_as_they_should(record: Any) -> None:
    surfaces = [
        (np.array(m["vertices"], dtype=float), m["faces"]) for m in (record["a"], record["b"])
    ]

    truth = agrees(*(body(surface) for surface in surfaces), surfaces)

    assert truth == [tuple(pair) for pair in record["exact_contact_pairs"]]
    assert bool(truth) == record["collides"]


@pytest.mark.parametrize("name", scenes.POSE_CLASSES)
def test_pose_classes_answer_as_they_are_made(name: str) -> None:
    pair = scenes.POSE_CLASSES[name](300)
    surfaces = [(s.vertices, s.faces) for s in (pair.a, pair.b)]
    pose = (pair.rotation, pair.translation)

    truth = agrees(body(surfaces[0]), body(surfaces[1], pose), surfaces, (UNTURNED, pose))

    assert pair.touches is None or bool(truth) == pair.touches
