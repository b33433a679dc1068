"""3MF: what the build places, by whom it is refused, and archives made to do harm."""

from __future__ import annotations

import zipfile

import pytest
from mesh_files.threemf_files import (
    ASSEMBLY,
    BY_PATH,
    LINKS,
    MESH,
    THREEMF_SEEDS,
    archive,
    group,
    mesh,
    model,
    shift,
)

from obbcli import MeshError, load_mesh, load_parts
from obbcli.mesh import load_mesh_bytes

CORNERS = [[0, 0, 0], [1, 0, 0], [0, 2, 0]]
ITEM = '<item objectid="1"/>'


def load(*content, **more):
    return load_mesh_bytes(archive(*content, **more), ".3mf")


def moved(x, y=0, z=0):
    return [[x + a, y + b, z + c] for a, b, c in CORNERS]


@pytest.mark.parametrize("packing", [zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED])
def test_an_item_shows_its_object(packing):
    found = load(packing=packing)

    assert found.vertices.tolist() == CORNERS
    assert found.triangles.tolist() == [[0, 1, 2]]
    assert (found.unit, found.notes) == ("mm", ())


@pytest.mark.parametrize(
    ("word", "unit"),
    [
        *(("micron", "um"), ("millimeter", "mm"), ("centimeter", "cm")),
        *(("inch", "in"), ("foot", "ft"), ("meter", "m")),
    ],
)
def test_the_unit_is_the_one_that_is_stated(word, unit):
    assert load(model(mesh(), more=f'unit="{word}"')).unit == unit


def test_transforms_are_four_rows_for_rows_of_points():
    # x goes to y, y to z, z to x; then comes the shift.
    found = load(model(mesh(), '<item objectid="1" transform="0 1 0 0 0 1 1 0 0 10 20 30"/>'))

    assert found.vertices.tolist() == [[10, 20, 30], [10, 21, 30], [10, 20, 32]]


def test_components_are_placed_within_their_objects_and_named_by_them(tmp_path):
    path = tmp_path / "pair.3mf"
    path.write_bytes(archive(ASSEMBLY))

    parts = load_parts(path).parts
    found = load_mesh(path)

    assert [part.path for part in parts] == ["pair/plate", "pair/plate#2", "plate"]
    assert parts[0].mesh is parts[1].mesh
    mirrored = [[-x, y, z] for x, y, z in CORNERS]
    assert found.vertices.tolist() == [*moved(0, 10), *moved(5, 10), *mirrored]
    # What is mirrored is turned over, so that its outside stays outside.
    assert found.triangles.tolist() == [[0, 1, 2], [3, 4, 5], [8, 7, 6]]
    assert load_mesh(f"{path}#pair").vertices.tolist() == [*moved(0, 10), *moved(5, 10)]


def test_what_no_item_places_is_left_out_and_told():
    found = load(model(mesh(1) + mesh(2)))

    assert len(found.triangles) == 1
    assert found.notes == ("1 of 2 objects stand in no item of the build",)


def test_supports_are_taken_and_told():
    found = load(model(mesh(1, 'type="support"')))

    assert len(found.triangles) == 1
    assert found.notes == ("objects that are supports are taken as well",)


def test_components_name_objects_of_other_parts():
    found = load_mesh_bytes(BY_PATH, ".3mf")

    assert found.vertices.tolist() == CORNERS
    assert found.notes == ()


def test_parts_of_two_units_are_refused():
    there = model(group(2, ("1", 'p:path="/3D/other.model"')), '<item objectid="2"/>')

    with pytest.raises(MeshError, match=r"other\.model: is in in, but 3D/3dmodel\.model in mm"):
        load(there, other=model(mesh(), "", 'unit="inch"'))


@pytest.mark.parametrize("name", ["/3D/../other.model", "http://x/3D/a.model", "C:\\a", "/"])
def test_no_part_lies_outside_of_the_archive(name):
    there = model(group(2, ("1", f'p:path="{name}"')), '<item objectid="2"/>')

    with pytest.raises(MeshError, match=r"line 2: names '.*', which is no part of the archive"):
        load(there)


def test_a_part_that_is_not_there_is_refused_where_it_is_named():
    there = model(group(2, ("1", 'p:path="/3D/other.model"')), '<item objectid="2"/>')

    with pytest.raises(MeshError, match=r"line 2: the archive holds '3D/other.model' 0 times"):
        load(there)


def test_an_archive_without_links_shows_the_usual_model_and_says_so():
    assert load(links=None).notes == ("says not which model it shows: 3D/3dmodel.model is taken",)


@pytest.mark.parametrize("suffix", [".stl", ".zip", ""])
def test_content_tells_a_3mf_file(tmp_path, suffix):
    path = tmp_path / f"part{suffix}"
    path.write_bytes(archive())

    found = load_mesh(path)

    assert found.vertices.tolist() == CORNERS
    assert found.notes == ("is a 3MF file by its content, and is read as such",)


def test_an_archive_of_another_kind_is_told(tmp_path):
    path = tmp_path / "part.3mf"
    with zipfile.ZipFile(path, "w") as file:
        file.writestr("a.txt", "x")

    with pytest.raises(
        MeshError, match="is a zip archive, not a mesh; unpack it and name the mesh"
    ):
        load_mesh(path)


def changed(old, new, objects=None):
    return model(objects or mesh()).replace(old, new)


LATTICE = '<b:beamlattice xmlns:b="b"/></mesh>'
BAD = {
    "comma": (changed('x="1"', 'x="1,5"'), r"model, line 4: '1,5' is not a number"),
    "underscore": (changed('x="1"', 'x="1_0"'), "'1_0' is not a number"),
    "nan": (changed('x="1"', 'x="nan"'), "'nan' is not a number"),
    "too large": (changed('x="1"', 'x="1e999"'), "'1e999' is not a number"),
    "no y": (changed(' y="0"', ""), "<vertex> has no attribute 'y'"),
    "index": (changed('v3="2"', 'v3="3"'), "a triangle names vertex 3, the last one is 2"),
    "negative": (changed('v3="2"', 'v3="-1"'), "'-1' is not the number of a vertex"),
    "element": (changed("<triangle ", "<quad/><triangle "), "<quad> is nothing that <triangles>"),
    "unit": (changed("<model", '<model unit="mile"'), "the unit is 'mile'; known are micron"),
    "extension": (
        changed("<model", '<model xmlns:z="urn:z" requiredextensions="p z"'),
        r"requires the extension 'z' \(urn:z\)",
    ),
    "not declared": (changed("<model", '<model requiredextensions="q"'), r"'q' \(not declared\)"),
    "lattice": (changed("</mesh>", LATTICE), "object 1 has a <beamlattice>; which is not read"),
    "missing": (model(mesh(), '<item objectid="7"/>'), "places object 7, which is not there"),
    "twice": (model(mesh() + mesh()), "there are two objects 1"),
    "other": (model(mesh(1, 'type="other"')), "object 1, whose type 'other' is not to be placed"),
    "itself": (model(group(1, ("1", ""))), "object 1 holds itself"),
    "nothing": (model(mesh(content="")), "object 1 has neither triangles nor components"),
    "transform": (
        model(mesh(), '<item objectid="1" transform="1 0 0"/>'),
        "a transform has 3 numbers, expected 12",
    ),
    "no items": (model(mesh(), ""), "has no faces"),
    "entity": (
        '<!DOCTYPE model [<!ENTITY a "b">]>' + model(mesh())[39:],
        "line 1: declares a document type",
    ),
    "outside": (
        '<!DOCTYPE m SYSTEM "file:///etc/passwd">' + model(mesh())[39:],
        "declares a document type",
    ),
    "cut": (model(mesh())[:-20], "is no whole XML: .*; it was cut short or damaged"),
    "encoding": (changed("UTF-8", "EBCDIC-X"), "unknown encoding|encoding that is not known"),
    "deep": ("<a>" * 300, "nests deeper than 200|<a> is nothing that <3MF> has"),
}


@pytest.mark.parametrize(("content", "fault"), BAD.values(), ids=BAD)
def test_what_is_wrong_in_a_model_is_refused_with_its_line(content, fault):
    with pytest.raises(MeshError, match=fault) as told:
        load(content)

    assert "Error" not in str(told.value)


def test_components_that_multiply_without_end_are_refused(monkeypatch):
    monkeypatch.setattr("obbcli.mesh.formats.threemf.reader.MOST_PARTS", 1000)
    doubled = "".join(group(k, (str(k - 1), ""), (str(k - 1), "")) for k in range(2, 40))

    with pytest.raises(MeshError, match="places more than 1000 objects; split the file"):
        load(model(mesh() + doubled, '<item objectid="39"/>'))


def test_archives_that_unpack_to_far_more_than_they_hold_are_refused():
    data = archive(model(mesh(), ITEM + " " * (90 << 20)))
    assert len(data) < 1 << 18

    with pytest.raises(MeshError, match=r"model: unpacks \d+ bytes to 9\d+; no model does"):
        load_mesh_bytes(data, ".3mf")


@pytest.mark.parametrize("packing", [zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_packings_that_3mf_forbids_are_refused(packing):
    with pytest.raises(MeshError, match="is packed in a way that 3MF forbids"):
        load(packing=packing)


def test_two_models_or_none_are_refused():
    doubled = LINKS.replace("</Relationships>", LINKS[LINKS.index("<Relationship ") :])

    with pytest.raises(MeshError, match=r"\.rels: names 2 models, expected one"):
        load(links=doubled)
    with pytest.raises(MeshError, match=r"\.rels: names 0 models, expected one"):
        load(links="<Relationships/>")


def test_every_cut_of_an_archive_is_refused():
    for data in THREEMF_SEEDS:
        for end in range(4, len(data), 7):
            with pytest.raises(MeshError, match="zip archive"):
                load_mesh_bytes(data[:end], ".3mf")


def test_every_changed_byte_of_a_packed_model_is_found():
    data = archive(ASSEMBLY)
    start = data.index(b"3D/3dmodel.model") + 16
    for place in range(start, start + 200, 3):
        wrong = bytearray(data)
        wrong[place] ^= 0x55
        with pytest.raises(MeshError):
            load_mesh_bytes(bytes(wrong), ".3mf")


def test_shifts_of_items_and_components_add_up():
    objects = mesh(1, content=MESH) + group(2, ("1", shift(1))) + group(3, ("2", shift(0, 2)))

    found = load(model(objects, f'<item objectid="3" {shift(0, 0, 3)}/>'))

    assert found.vertices.tolist() == moved(1, 2, 3)


@pytest.mark.parametrize("word", ["1", "+1", " 1 ", "1.", "1.0", "10e-1", "0.1E+1"])
def test_numbers_may_be_written_in_every_way_that_3mf_knows(word):
    assert load(changed('x="1"', f'x="{word}"')).vertices.tolist() == CORNERS


@pytest.mark.parametrize("word", ["1_0", "", "one", "inf", "-inf", "nan", "0x1", "\u0661", "1 1"])
def test_what_python_takes_for_a_number_need_be_none_of_3mf(word):
    with pytest.raises(MeshError, match=r"line 4: '.*' is not a number; export it again"):
        load(changed('x="1"', f'x="{word}"'))


@pytest.mark.parametrize("word", ["1", "+1", " 1 ", "01"])
def test_indices_may_be_written_in_every_way_that_3mf_knows(word):
    assert load(changed('v2="1"', f'v2="{word}"')).triangles.tolist() == [[0, 1, 2]]


@pytest.mark.parametrize("word", ["1_0", "", "1.0", "\u0661", "\u00b2", "9" * 40, "-1"])
def test_what_python_takes_for_an_index_need_be_none_of_3mf(word):
    with pytest.raises(MeshError, match=r"line 6: '.*' is not the number of a vertex"):
        load(changed('v2="1"', f'v2="{word}"'))


def test_coordinates_whose_sum_is_out_of_range_are_read():
    found = load(changed('x="1" y="0"', 'x="1e308" y="1e308"'))

    assert found.vertices[1].tolist() == [1e308, 1e308, 0]
