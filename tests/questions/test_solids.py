"""`solid=True`: bodies inside each other, by boxes whose truth is that of intervals."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from meshes.solids import joined, shifted, turned_over, unshared
from meshes.surfaces import sphere, torus
from movers.meshes import box, cube, tube
from scenes.pairs import THIRD_TURN, random_rotation
from strategies.still import examples

import obbcli
from obbcli import Body, Mesh, ObbTree, Pose, Status

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    Draw = Callable[..., Any]


Range = tuple[int, int]
Ranges = tuple[Range, Range, Range]

INNER, OUTER = Mesh(*cube(1.0)), Mesh(*cube(2.0))
HOLLOW = Mesh(*joined(cube(4.0), turned_over(cube(2.0))))


def contained(a: Any, b: Any) -> str | None:
    """Return which body lies in the other, after checking that all answers agree."""
    found = obbcli.first_contact(a, b, solid=True)
    collision = obbcli.collide(a, b, solid=True)
    swapped = obbcli.first_contact(b, a, solid=True)

    assert collision.contained == found.contained
    assert collision.status is found.status is swapped.status
    assert (swapped.contained is None) == (found.contained is None)
    if found.contained is not None:
        assert found.status is Status.OVERLAP_AT_START
        assert collision.witness is None
        assert not obbcli.collide(a, b).collides
    return found.contained


# ---- Intervals as truth


@st.composite
def box_ranges(draw: Draw) -> Ranges:
    """Return a box on a small grid as its range on each axis."""
    ranges = [sorted(draw(st.tuples(*[st.integers(-4, 4)] * 2))) for _ in range(3)]
    x, y, z = ((low, high + (low == high)) for low, high in ranges)
    return x, y, z


def meet(p: Ranges, q: Ranges) -> bool:
    """Return whether two closed boxes have a point in common."""
    return all(a[0] <= b[1] and b[0] <= a[1] for a, b in zip(p, q, strict=True))


def is_within(p: Ranges, q: Ranges) -> bool:
    """Return whether p lies in q without touching its surface."""
    return all(b[0] < a[0] and a[1] < b[1] for a, b in zip(p, q, strict=True))


def mesh_of(boxes: list[Ranges]) -> Mesh:
    return Mesh(*joined(*(box(*zip(*ranges, strict=True)) for ranges in boxes)))


def truth(a: list[Ranges], b: list[Ranges]) -> tuple[bool, str | None]:
    """Return whether solids overlap, and which one has a part inside the other untouched."""
    pairs = [(p, q) for p in a for q in b]
    if any(meet(p, q) and not is_within(p, q) and not is_within(q, p) for p, q in pairs):
        return True, None
    if any(is_within(p, q) for p, q in pairs):
        return True, "a"
    inner = "b" if any(is_within(q, p) for p, q in pairs) else None
    return inner is not None, inner


BOXES = st.lists(box_ranges(), min_size=1, max_size=3)
POSES = st.sampled_from([Pose(), Pose(THIRD_TURN), Pose(translation=(0.25, -8.0, 1024.0))])


@examples(500)
@given(BOXES, BOXES, POSES)
def test_bodies_of_boxes_overlap_as_their_intervals_do(a, b, pose):
    # Boxes of one body may lie in each other, which changes nothing, but not share an edge.
    for parts in (a, b):
        assume(Mesh(*joined(*(box(*zip(*part, strict=True)) for part in parts))).is_watertight)
    overlaps, inner = truth(a, b)

    found = obbcli.first_contact(Body(mesh_of(a), pose), Body(mesh_of(b), pose), solid=True)

    assert found.collides == overlaps
    assert found.contained == inner
    if inner is not None:
        assert found.point is not None
        vertices = mesh_of(a if inner == "a" else b).vertices
        assert list(found.point) in pose.apply(vertices).tolist()


# ---- What lies inside what


def test_cube_in_cube_is_found_from_either_side():
    assert contained(INNER, OUTER) == "a"
    assert contained(OUTER, INNER) == "b"


def test_cubes_side_by_side_do_not_contain_each_other():
    assert contained(INNER, Mesh(*shifted(cube(), (2.5, 0, 0)))) is None


def test_touching_from_inside_is_contact_of_triangles():
    corner = Mesh(*shifted(cube(), (1, 0, 0)))

    found = obbcli.first_contact(corner, OUTER, solid=True)

    assert found.status is Status.OVERLAP_AT_START
    assert found.contained is None
    assert found.evidence == "intersecting"
    assert found.triangle_a is not None


def test_one_ulp_between_surfaces_is_enough():
    edge = float(np.nextafter(1.0, 2.0))

    assert contained(INNER, Mesh(*cube(edge))) == "a"
    assert obbcli.first_contact(INNER, INNER, solid=True).contained is None


def test_hollow_turned_inwards_holds_nothing():
    assert contained(INNER, HOLLOW) is None
    assert contained(HOLLOW, Mesh(*cube(5.0))) == "a"


def test_shell_within_a_shell_is_found_in_the_wall_alone():
    assert contained(Mesh(*shifted(cube(0.5), (3, 0, 0))), HOLLOW) == "a"
    assert contained(Mesh(*joined(cube(3.0), turned_over(cube(2.5)))), HOLLOW) == "a"
    assert contained(Mesh(*joined(cube(1.5), turned_over(cube(1.0)))), HOLLOW) is None


def test_overlap_of_parts_is_inside_however_they_are_turned():
    parts = [box((-3, -3, -3), (1.5, 3, 3)), box((-1.5, -2, -2), (4, 2, 2))]

    assert contained(INNER, Mesh(*joined(*parts))) == "a"
    assert contained(INNER, Mesh(*joined(*map(turned_over, parts)))) == "a"


def test_body_in_the_hole_of_a_ring_is_not_inside():
    ring = torus(2000, 0.3)
    small = sphere(320, 0.1)
    tree = ObbTree.build(Mesh(ring.vertices, ring.faces))
    ball = ObbTree.build(Mesh(small.vertices, small.faces))

    assert contained(ball, tree) is None
    assert contained(Body(ball, Pose(translation=(1, 0, 0))), tree) == "a"
    assert contained(Body(ball, Pose(translation=(0, 0, 0.25))), tree) is None
    assert contained(INNER, Mesh(*tube(1.25, 2, -1, 1))) is None


def test_linked_rings_are_outside_each_other():
    ring = torus(2000, 0.3)
    mesh = Mesh(ring.vertices, ring.faces)
    turn = Pose((math.pi / 2, 0, 0), (1, 0, 0))

    assert contained(mesh, Body(mesh, turn)) is None


def test_each_part_of_either_body_is_asked():
    far, near = shifted(cube(), (50, 0, 0)), cube(0.5)
    cubes = [shifted(cube(), (-5 * k, 7, 0)) for k in range(20)]

    assert contained(Mesh(*joined(far, *cubes, near)), OUTER) == "a"
    assert contained(OUTER, Mesh(*joined(far, *cubes, near))) == "b"
    assert contained(Mesh(*joined(far, *cubes)), OUTER) is None


def test_parts_inside_each_other_both_ways_name_a_first():
    a = Mesh(*joined(cube(1.0), shifted(cube(2.0), (10, 0, 0))))
    b = Mesh(*joined(cube(2.0), shifted(cube(1.0), (10, 0, 0))))

    assert contained(a, b) == contained(b, a) == "a"


def test_triangles_that_share_no_vertices_close_by_their_places():
    assert contained(Mesh(*unshared(cube())), Mesh(*unshared(cube(2.0)))) == "a"


def test_collapsed_triangle_inside_is_a_part_inside():
    vertices, faces = cube()
    crumb = np.array([[9, 0, 0], [9, 0, 0]], dtype=np.float64)
    mesh = Mesh(np.concatenate((vertices, crumb)), [*faces.tolist(), [8, 9, 8]])

    assert mesh.is_watertight
    assert contained(mesh, Mesh(*shifted(cube(), (9, 0, 0)))) == "a"
    assert contained(mesh, Mesh(*shifted(cube(), (-9, 0, 0)))) is None


@pytest.mark.parametrize("scale", [1e-300, 1e-12, 1e12, 1e300])
def test_scale_changes_nothing(scale):
    assert contained(Mesh(*cube(scale)), Mesh(*cube(1.5 * scale))) == "a"
    assert contained(Mesh(*cube(scale)), Mesh(*shifted(cube(scale), (2.5 * scale, 0, 0)))) is None


@pytest.mark.parametrize("seed", range(8))
def test_far_from_the_origin_and_turned_any_way_bodies_stay_inside(seed):
    shift = np.array([1e9, -1e9, 3e8])
    inner, outer = Pose(random_rotation(seed), shift), Pose(random_rotation(seed + 100), shift)
    beside = Pose(random_rotation(seed), shift + np.array([0, 0, 4.0]))

    assert contained(Body(INNER, inner), Body(OUTER, outer)) == "a"
    assert contained(Body(INNER, beside), Body(INNER, outer)) is None


@pytest.mark.parametrize("options", [{"leaf_size": 100}, {"max_depth": 0}, {"fit": "points"}])
def test_any_tree_gives_the_same_answer(options):
    ball = sphere(1280)
    tree = ObbTree.build(Mesh(ball.vertices, ball.faces), **options)

    assert contained(ObbTree.build(Mesh(*cube(0.5))), tree) == "a"
    assert contained(tree, ObbTree.build(OUTER, **options)) == "a"


def test_tree_files_hold_what_is_needed(tmp_path: Path):
    ObbTree.build(OUTER).save(tmp_path / "outer.obbt")

    assert contained(INNER, tmp_path / "outer.obbt") == "a"
