"""STEP files that are refused: damaged, empty, hostile, or without the package that reads them."""

from __future__ import annotations

import importlib.util
import re

import pytest
from mesh_files.step_files import HEAD, ORIGIN, TAIL, StepFile, box, sphere

from obbcli import MeshError, load_mesh, load_parts
from obbcli.mesh import load_mesh_bytes
from obbcli.mesh.formats.step import process

needs_ocp = pytest.mark.needs("cadquery-ocp-novtk")
AGAIN = "export it again, or as STL"


def refusal(data, suffix=".step", **more):
    with pytest.raises(MeshError) as caught:
        load_mesh_bytes(data, suffix, name="a.step", **more)
    return str(caught.value)


def test_without_the_package_the_refusal_names_it(monkeypatch):
    monkeypatch.setattr(importlib.util, "find_spec", lambda _: None)

    assert refusal(box()) == (
        "a.step: is a STEP file, which takes the package cadquery-ocp-novtk; "
        "install it: pip install cadquery-ocp-novtk"
    )


@pytest.mark.parametrize("kept", [0.3, 0.9, 0.99])
def test_a_file_that_was_cut_short_is_refused(kept):
    data = box()

    assert refusal(data[: int(kept * len(data))]) == (
        "a.step: does not end with END-ISO-10303-21: it was cut short; copy or download it again"
    )


def test_a_building_is_no_step_assembly():
    text = HEAD.replace("AUTOMOTIVE_DESIGN", "IFC4") + TAIL

    assert refusal(text.encode()) == (
        "a.step: is an IFC model of a building, not a mesh; export it as glTF or OBJ"
    )


@pytest.mark.parametrize("sag", [0.0, -1.0, float("nan"), float("inf"), "1", True])
def test_a_sag_that_is_none_is_refused(sag):
    text = re.escape(f"sag: is {sag!r}; use a finite number above 0")
    with pytest.raises(MeshError, match=f"^{text}$"):
        load_mesh("sample_meshes/gear.stl", sag=sag)


@pytest.mark.parametrize("load", [load_mesh, load_parts])
@pytest.mark.parametrize("path", ["gear.stl", "nut.obj", "nut.obj#nut"])
def test_a_sag_for_triangles_is_refused(load, path):
    words = "holds triangles and no exact surfaces, which a sag would cut; leave out the sag"
    with pytest.raises(MeshError, match=words):
        load(f"sample_meshes/{path}", sag=0.1)


@needs_ocp
@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (b"PLANE(''", b"PLAIN(''", r"#\d+: holds ADVANCED_FACE that cannot be read: .*; " + AGAIN),
        (b"EDGE_LOOP", b"EDGE_LOOB", r"#\d+: holds FACE_OUTER_BOUND that cannot be read: "),
        (b"CLOSED_SHELL", b"CLOSED_SHALL", r"#\d+: holds MANIFOLD_SOLID_BREP that cannot be read"),
        (b"DIRECTION('',(", b"DIRECTION('',(x,", r"#\d+: holds DIRECTION that cannot be read"),
        (b"CARTESIAN_POINT('',(0", b"CARTESIAN_POINT('',('0'", "CARTESIAN_POINT that cannot be"),
        (b"SI_UNIT(.MILLI.", b"SI_UNIT(.MIDDLE.", "SI_UNIT.* that cannot be read"),
    ],
)
def test_damage_is_named_with_its_entity(old, new, words):
    assert re.search(words, refusal(box().replace(old, new, 1)))


@needs_ocp
def test_a_face_that_would_be_lost_is_named():
    file = StepFile()
    faces = file.faces_of_box((0, 0, 0), (1, 2, 3))
    plane = next(k for k, line in enumerate(file.lines) if "PLANE('" in line)
    axes = file.axes((0.5, 0.5, 7), (0, 0, 1), (1, 0, 0))
    file.lines[plane] = f"#{plane + 1}=SPHERICAL_SURFACE('',{axes},0.25);\n"
    file.product("box", [file.solid(faces)])
    said = refusal(file.bytes())

    assert re.fullmatch(r"a\.step: .*(lost|fault of its own|gives up|miss by).*; .*STL.*", said)


@needs_ocp
def test_a_solid_of_another_kind_is_not_lost_in_silence():
    file = StepFile()
    block = file.add(f"BLOCK('',{file.axes(*ORIGIN)},1.,2.,3.)")
    file.product("box", [file.solid(file.faces_of_box((0, 0, 0), (1, 2, 3)))])
    csg = file.add(f"CSG_SOLID('',{block})")
    file.product("block", [csg], "CSG_SHAPE_REPRESENTATION")

    assert re.search(r"a\.step.*(BLOCK|CSG)", refusal(file.bytes()))


@needs_ocp
@pytest.mark.parametrize("items", [0, 3])
def test_a_file_without_a_face_is_refused(items):
    file = StepFile()
    points = [file.point((k, 0, 0)) for k in range(items)]
    file.product("nothing", points, "SHAPE_REPRESENTATION")

    assert refusal(file.bytes()) == (
        "a.step: has no faces: no product has a surface; "
        "export solids or surfaces: wires, points and drawings have none"
    )


@needs_ocp
@pytest.mark.parametrize("text", ["", "#1=", "#1=#1;", "garbage", "#1=PRODUCT('", "(((((", "'"])
def test_a_file_of_nothing_is_refused(text):
    assert refusal((HEAD + text + TAIL).encode()).startswith("a.step: ")


@needs_ocp
def test_parts_in_other_files_are_named_and_not_opened(tmp_path):
    file = StepFile()
    defined, shape = file.definition("arm")
    drawn = file.add(f"SHAPE_REPRESENTATION('',({file.axes(*ORIGIN)}),{file.context})")
    file.add(f"SHAPE_DEFINITION_REPRESENTATION({shape},{drawn})")
    kind = file.add("DOCUMENT_TYPE('geometry')")
    (tmp_path / "arm.stp").write_bytes(box())
    document = file.add(f"DOCUMENT_FILE('arm.stp','','',{kind},'',$)")
    role = file.add("OBJECT_ROLE('mandatory','')")
    used = file.add(f"APPLIED_DOCUMENT_REFERENCE({document},'',({defined}))")
    file.add(f"ROLE_ASSOCIATION({role},{used})")
    source = file.add("EXTERNAL_SOURCE(IDENTIFIER(''))")
    named = file.add("IDENTIFICATION_ROLE('external document id and location','')")
    file.add(f"APPLIED_EXTERNAL_IDENTIFICATION_ASSIGNMENT('arm.stp',{named},{source},({document}))")
    file.product("box", [file.solid(file.faces_of_box((0, 0, 0), (1, 2, 3)))])
    path = tmp_path / "a.step"
    path.write_bytes(file.bytes())

    words = r"has parts in other files, which are not read: arm\.stp; export the assembly"
    with pytest.raises(MeshError, match=words):
        load_mesh(path)


@needs_ocp
def test_an_assembly_that_holds_itself_is_refused():
    file = StepFile()
    ball = file.product("ball", [file.solid([file.face_of_sphere(1.0)])])
    inner = file.assembly("inner", ("ball", ball, ORIGIN))
    file.assembly("outer", ("inner", inner, ORIGIN))
    text = file.bytes()
    use = re.search(rb"NEXT_ASSEMBLY_USAGE_OCCURRENCE\('0','inner','',(#\d+),(#\d+)", text)
    loop = text.replace(use[0], use[0].replace(use[1], use[2], 1))

    assert refusal(loop).startswith("a.step: ")


@needs_ocp
@pytest.mark.parametrize("seconds", [3, 3000])
def test_a_sag_that_takes_time_or_memory_without_end_is_refused(monkeypatch, tmp_path, seconds):
    monkeypatch.setattr(process, "SECONDS", seconds)
    monkeypatch.setattr(process, "most_bytes", lambda: -3 << 30)
    path = tmp_path / "a.step"
    path.write_bytes(sphere())
    (part,) = load_parts(path, sag=1e-9)

    with pytest.raises(MeshError, match=r"product 'ball': .*(too long|memory|gives up|fault of)"):
        _ = part.mesh
