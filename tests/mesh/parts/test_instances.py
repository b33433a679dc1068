"""Abaqus instances, zones of SU2 and Tecplot, blocks of VTK: what of them is a part, and shared."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from claims.parts import corners, require_whole
from mesh_files.abaqus_decks import PART, TETRA
from mesh_files.part_files import WRITERS

from obbcli import Body, Mesh, MeshError, Pose, collide, distance, load_mesh, load_parts

SHEET = (
    "*PART, NAME=Sheet\n*NODE\n1,0,0,0\n2,2,0,0\n3,0,2,1\n*ELEMENT, TYPE=S3\n1,1,2,3\n*END PART\n"
)


def instance(name, part, *lines, more=""):
    return "\n".join([f"*INSTANCE, NAME={name}, PART={part}", *lines, more + "*END INSTANCE\n"])


def deck(tmp_path, text):
    path = tmp_path / "a.inp"
    path.write_text(text)
    return path


def described(path):
    return [(part.path, len(part.mesh.triangles)) for part in load_parts(path)]


def test_instances_of_a_part_share_its_mesh_and_have_poses(tmp_path):
    turned = "0, 0, 1", "0, 0, 0, 2, 2, 2, 120"
    path = deck(
        tmp_path,
        PART
        + SHEET
        + instance("one", "Tet")
        + instance("two", "Tet", "10, 0, 0.1")
        + instance("flat", "Sheet")
        + instance("three", "Tet", *turned),
    )

    one, two, flat, three = load_parts(path)

    assert one.mesh is two.mesh is three.mesh
    assert flat.mesh is not one.mesh
    assert two.pose.translation.tolist() == [10, 0, 0.1]
    # A third of a turn about (1, 1, 1) takes x to y, y to z and z to x.
    np.testing.assert_allclose(three.pose.rotation, [[0, 0, 1], [1, 0, 0], [0, 1, 0]], atol=1e-15)
    np.testing.assert_allclose(three.pose.translation, [1, 0, 0], atol=1e-15)
    require_whole(path)


@pytest.mark.parametrize("degrees", [30, 90, -180, 270, 1e-7, 359.5])
def test_turned_instance_is_where_the_definition_puts_it(tmp_path, degrees):
    # First moved by (1, 2, 3), then turned about the line along y through (5, 0, -1).
    path = deck(tmp_path, PART + instance("a", "Tet", "1, 2, 3", f"5, 0, -1, 5, 4, -1, {degrees}"))

    found = load_mesh(path).vertices

    sine, cosine = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
    for before, after in zip(load_parts(path).parts[0].mesh.vertices, found, strict=True):
        x, y, z = before + np.array([1 - 5, 2, 3 + 1])
        expected = [cosine * x + sine * z + 5, y, cosine * z - sine * x - 1]
        np.testing.assert_allclose(after, expected, rtol=0, atol=5e-15)
    require_whole(path)


@pytest.mark.parametrize("degrees", [360.0 * 2**50, 1e16, 7.2e17, 1e300])
def test_angles_of_many_turns_are_turns(tmp_path, degrees):
    path = deck(tmp_path, PART + instance("a", "Tet", "0, 0, 0", f"0, 0, 0, 0, 0, 1, {degrees!r}"))

    (part,) = load_parts(path)

    # By whole numbers, without rounding.
    angle = math.radians(int(degrees) % 360)
    expected = [[math.cos(angle), -math.sin(angle), 0], [math.sin(angle), math.cos(angle), 0]]
    np.testing.assert_allclose(part.pose.rotation[:2], expected, rtol=0, atol=1e-15)
    require_whole(path)


def test_instances_with_sets_of_their_own_share_the_mesh(tmp_path):
    sets = "*NSET, NSET=top\n1, 2\n*ELSET, ELSET=all\n1\n"
    path = deck(tmp_path, PART + instance("a", "Tet", more=sets) + instance("b", "Tet", "1, 2, 3"))

    a, b = load_parts(path)

    assert a.mesh is b.mesh
    require_whole(path)


def test_instance_that_defines_more_has_a_mesh_of_its_own(tmp_path):
    own = "*NODE\n5, 3, 3, 3\n*ELEMENT, TYPE=S3\n9, 1, 2, 5\n"
    path = deck(tmp_path, PART + instance("a", "Tet") + instance("b", "Tet", "9, 0, 0", own))

    assert described(path) == [("a", 4), ("b", 5)]
    require_whole(path)


def test_parts_that_no_instance_places_are_parts_where_they_are_written(tmp_path):
    path = deck(tmp_path, PART + SHEET + TETRA)

    assert described(path) == [("Tet", 4), ("Sheet", 1), ("", 4)]
    require_whole(path)


def test_flat_deck_is_one_part_without_a_name(tmp_path):
    # Sets of elements are no parts: one element may be in many.
    path = deck(tmp_path, TETRA + "*ELSET, ELSET=a\n1\n*ELSET, ELSET=b\n1\n")

    assert described(path) == [("", 4)]
    require_whole(path)


def test_instances_without_surface_are_no_parts(tmp_path):
    beam = "*PART, NAME=Beam\n*NODE\n1,0,0,0\n2,1,0,0\n*ELEMENT, TYPE=B31\n1,1,2\n*END PART\n"
    path = deck(tmp_path, PART + beam + instance("b", "Beam") + instance("t", "Tet"))

    assert described(path) == [("t", 4)]
    require_whole(path)
    for text in (beam + instance("b", "Beam"), "*NODE\n1, 0, 0, 0\n"):
        with pytest.raises(MeshError) as whole:
            load_mesh(deck(tmp_path, text))
        with pytest.raises(MeshError, match="has no surface") as parts:
            load_parts(path)
        assert str(parts.value) == str(whole.value)


def test_names_of_instances_may_be_equal_or_missing(tmp_path):
    lines = [instance(name, "Tet") for name in ("a", "a", "")]
    path = deck(tmp_path, PART + "".join(lines) + "*INSTANCE, PART=Tet\n*END INSTANCE\n")

    assert [part.path for part in load_parts(path)] == ["a", "a#2", "", "#2"]


def test_notes_of_a_part_are_those_of_its_own_lines(tmp_path):
    again = PART.replace("*END PART", "*NODE\n4, 0, 0, 3\n*END PART").replace("Tet", "Twice")
    path = deck(tmp_path, PART + again + instance("a", "Tet") + instance("b", "Twice"))

    a, b = load_parts(path)

    told = "1 node defined more than once taken where defined last"
    assert told not in a.mesh.notes
    assert told in b.mesh.notes
    assert told in load_mesh(path).notes


@pytest.mark.parametrize("keyword", ["*NMAP, NSET=a", "*FROB, NAME=a", "*PART, NAME=Tet"])
def test_what_may_make_or_place_surface_is_refused_whatever_is_asked(tmp_path, keyword):
    path = deck(tmp_path, PART + f"{keyword}\n" + instance("a", "Tet"))

    with pytest.raises(MeshError):
        load_mesh(path)
    with pytest.raises(MeshError):
        load_mesh(f"{path}#a")


def test_deck_that_is_cut_short_is_refused_whatever_is_asked(tmp_path):
    text = PART + SHEET + instance("a", "Tet") + instance("b", "Sheet")
    path = deck(tmp_path, text[: text.rindex("*END")])

    with pytest.raises(MeshError, match="ends within the part or instance 'b'"):
        load_mesh(f"{path}#a")


def test_copies_answer_as_meshes_that_are_copies_bit_for_bit(tmp_path):
    places = (("a", ("0.3, 0.1, 0",)), ("b", ("1.1, 0.4, 0.2", "0, 0, 0, 1, 2, 3, 40")))
    path = deck(tmp_path, PART + "".join(instance(n, "Tet", *p) for n, p in places))
    a, b = load_parts(path)

    copies = [
        Body(
            Mesh(part.mesh.vertices, part.mesh.triangles),
            Pose(part.pose.rotation, part.pose.translation),
        )
        for part in (a, b)
    ]
    files = [f"{path}#a", f"{path}#b"]

    for one, two in ((a, b), (b, a)):
        shared, apart = distance(one, two), distance(*(copies if one is a else copies[::-1]))
        baked = distance(*(files if one is a else files[::-1]))
        for other in (apart, baked):
            assert (shared.bounds, shared.triangle_a, shared.triangle_b) == (
                *(other.bounds, other.triangle_a),
                other.triangle_b,
            )
    assert collide(a, b).status is collide(*files).status


@pytest.mark.parametrize("kind", ["Tecplot", "SU2"])
def test_single_zone_without_a_name_is_one_part(tmp_path, kind):
    path = WRITERS[kind](tmp_path, [("", (0, 0, 0))])
    lines = path.read_text().splitlines()
    kept = [line for line in lines if not line.startswith(("NZONE", "IZONE"))]
    path.write_text("\n".join(kept).replace('T="", ', "") + "\n")

    assert described(path) == [("", 12)]
    require_whole(path)


def test_zones_of_tecplot_share_what_they_take_from_others(tmp_path):
    path = WRITERS["Tecplot"](tmp_path, [("a", (0.0, 0.0, 0.0))])
    shared = 'ZONE T="b", N=8, E=12, F=FEPOINT, ET=TRIANGLE, VARSHARELIST=([2-3]=1)'
    xs = "\n".join(str(5.5 + (corner & 1)) for corner in range(8))
    path.write_text(path.read_text() + f"{shared}, CONNECTIVITYSHAREZONE=1\n{xs}\n")

    assert described(path) == [("a", 12), ("b", 12)]
    assert load_mesh(f"{path}#b").bounds.tolist() == [[5.5, 0, 0], [6.5, 1, 1]]
    require_whole(path)


def test_zones_of_tecplot_without_surface_and_at_later_times_are_no_parts(tmp_path):
    line = 'ZONE T="line", I=2, F=POINT\n0 0 0\n1 1 1\n'
    path = WRITERS["Tecplot"](tmp_path, [("a", (0, 0, 0)), ("b", (3, 0, 0)), ("a", (0, 0, 0))])
    text = path.read_text() + line
    for name, strand, time in (("a", 1, 0), ("b", 2, 0), ("a", 1, 5)):
        text = text.replace(
            f'T="{name}", N', f'STRANDID={strand}, SOLUTIONTIME={time}, T="{name}", N', 1
        )
        text = text.replace(f'T="{name}"', f'T = "{name}"', 1)
    path.write_text(text)

    assert described(path) == [("a", 12), ("b", 12)]
    require_whole(path)
    # One that has moved by then is told where it is asked about, and only there.
    head, _, last = text.rpartition("ZONE STRANDID=1")
    path.write_text(head + "ZONE STRANDID=1" + last.replace("0.0 0.0 0.0", "0.0 0.0 7.0", 1))
    assert len(load_mesh(f"{path}#b").triangles) == 12
    for name in (f"{path}#a", path):
        with pytest.raises(MeshError, match="the mesh of strand 1 differs between solution times"):
            load_mesh(name)


def test_blocks_without_surface_are_no_parts(tmp_path):
    path = WRITERS["VTK"](tmp_path, [("line", (0, 0, 0)), ("a", (1, 0, 0))])
    text = (tmp_path / "0.vtu").read_text()
    # Twelve lines in place of twelve triangles.
    for name, numbers in (
        ("connectivity", [k % 8 for k in range(24)]),
        ("offsets", range(2, 26, 2)),
        ("types", [3] * 12),
    ):
        row = " ".join(map(str, numbers))
        text = re.sub(rf'(Name="{name}"[^>]*>)[^<]*', rf"\g<1>{row}", text)
    (tmp_path / "0.vtu").write_text(text)

    assert described(path) == [("a", 12)]
    assert corners(load_mesh(path)).tobytes() == corners(load_mesh(f"{path}#a")).tobytes()
    with pytest.raises(MeshError, match=r"a\.vtm: has no faces"):
        load_mesh(f"{path}#line")
