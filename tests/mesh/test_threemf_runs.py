"""3MF: runs of elements that are taken at once are what expat brings, one by one."""

from __future__ import annotations

import re
import zipfile
from itertools import pairwise

import pytest
from mesh_files.threemf_files import archive, mesh, model

from obbcli import MeshError
from obbcli.mesh import load_mesh_bytes
from obbcli.mesh.formats.threemf import archive as packing
from obbcli.mesh.formats.threemf import runs as plain_runs

ITEMS = '<item objectid="1"/><item objectid="2"/>'


def listed(ends, *triangles):
    vertices = ends.join(f'<vertex x="{k}.5" y="-{k}e-3" z="{k * k}"/>' for k in range(6))
    return (
        f"<mesh><vertices>{ends}{vertices}{ends}</vertices>{ends}"
        f"<triangles>{ends.join(triangles)}{ends}</triangles></mesh>"
    )


#: Two meshes as different programs write them.
PLAIN = listed("\n", *(f'<triangle v1="{k}" v2="{k + 1}" v3="{k + 2}"/>' for k in range(4)))
COLORED = listed(
    "\r\n  ",
    *(f'<triangle v1="{k}" v2="{k + 1}" v3="{k + 2}" pid="1" p1="{k}" />' for k in range(4)),
)
MODEL = model(mesh(1, content=PLAIN) + mesh(2, content=COLORED), ITEMS)
#: What may stand anywhere in a text that programs or people write, or that damage leaves.
ODD = [
    *("<!--", "<!-- -->", "-->", "<![CDATA[", "]]>", "<?a ?>", "<?a ", "<", ">", "/>", '"', "'"),
    *("</vertices>", "<vertices>", "</triangles>", "<triangles>", "<a>", "</a>", '<a b="/>"/>'),
    *('<vertex x="1" y="2" z="3"/>', '<vertex z="3" y="2" x="1" ></vertex>', '<vertex x="1"/>'),
    *('<triangle v1="0" v2="1" v3="2"/>', '<triangle v1="0" v2="1" v3="99"/>', "<triangle/>"),
    *(' x="1"', ' xmlns=""', ' xmlns="urn:a"', ' xmlns:m="urn:a"', ' m:a="1"', ' name="a"'),
    *("1", "-", "e9", "e999", "_1", "inf", ".", "+", " ", "\r", "\n\n", "\0", "&#49;", "&amp;"),
    *("9" * 30, "0" * 30, "\u0661", "\u00e9"),
]


def outcome(text, name="<stdin>"):
    """Return the bits and notes of the mesh in a model, or what refuses it."""
    stored = archive(text, zipfile.ZIP_STORED)
    try:
        found = load_mesh_bytes(stored, ".3mf", name=name)
    except MeshError as fault:
        return str(fault)
    return found.vertices.tobytes(), found.triangles.tobytes(), found.notes, found.unit


@pytest.fixture
def one_by_one(monkeypatch):
    """Return a function that lets expat bring all elements from now on, or no longer."""
    taken = plain_runs.Run.words

    def let(is_so):
        monkeypatch.setattr(plain_runs.Run, "words", (lambda *_: None) if is_so else taken)

    return let


@pytest.fixture
def runs(monkeypatch):
    """Return the sizes of the runs that are taken, as they are."""
    sizes = []
    taken = plain_runs.Run.words

    def words(run, wanted):
        found = taken(run, wanted)
        if found is not None:
            sizes.append(len(found) // 3)
        return found

    monkeypatch.setattr(plain_runs.Run, "words", words)
    return sizes


def test_plain_elements_are_taken_in_runs(runs):
    outcome(MODEL)

    assert runs == [6, 4, 6, 4]


def test_runs_hold_the_numbers_that_are_written(runs):
    found = load_mesh_bytes(archive(MODEL), ".3mf")

    corners = [[k + 0.5, float(f"-{k}e-3"), k * k] for k in range(6)]
    assert found.vertices.tolist() == corners * 2
    rows = [[k, k + 1, k + 2] for k in range(4)]
    assert found.triangles.tolist() == [*rows, *([a + 6 for a in row] for row in rows)]
    assert len(runs) == 4


@pytest.mark.parametrize("at_least", [1, 1 << 18])
@pytest.mark.parametrize("odd", ODD)
def test_whatever_stands_in_a_run_means_what_it_means_to_expat(
    monkeypatch, one_by_one, odd, at_least
):
    monkeypatch.setattr(plain_runs, "_AT_LEAST", at_least)
    first, last = MODEL.index("<vertices>"), MODEL.rindex("</triangles>")
    places = [m.end() for m in re.finditer(r"[<>\" ]", MODEL[:last]) if m.end() > first]
    # Some of all places, others for each of the odd things.
    texts = [MODEL[:k] + odd + MODEL[k:] for k in places[ODD.index(odd) % 12 :: 12]]

    found = [outcome(text) for text in texts]
    one_by_one(True)
    expected = [outcome(text) for text in texts]

    assert found == expected


@pytest.mark.parametrize("piece", [1, 7, 64])
@pytest.mark.parametrize("at_least", [1, 100])
def test_pieces_of_a_text_may_end_anywhere(monkeypatch, runs, piece, at_least):
    whole = outcome(MODEL)
    monkeypatch.setattr(packing, "_PIECE", piece)
    monkeypatch.setattr(plain_runs, "_AT_LEAST", at_least)
    runs.clear()

    assert outcome(MODEL) == whole
    assert len(runs) > 4


@pytest.mark.parametrize(
    ("opens", "closes"), [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?a ", "?>")]
)
def test_elements_within_what_is_no_element_are_not_taken(monkeypatch, opens, closes):
    # Pieces end within it, each after what looks like an element of the list.
    monkeypatch.setattr(plain_runs, "_AT_LEAST", 1)
    monkeypatch.setattr(packing, "_PIECE", 16)
    inside = '<vertex x="7" y="7" z="7"/>\n' * 9
    text = MODEL.replace("<vertices>", f"<vertices>{opens}<vertices>{inside}{closes}")

    assert outcome(text) == outcome(MODEL)


@pytest.mark.parametrize("start", ["<vertices xmlns='urn:a'>", "<mesh xmlns=''>", "<p:vertices>"])
def test_elements_of_another_namespace_are_not_taken(one_by_one, start):
    name = re.match("<([a-z:]+)", start)[1]
    old = f"<{name.rpartition(':')[2]}>"
    text = MODEL.replace(old, start).replace(f"</{old[1:]}", f"</{name}>")

    found = outcome(text)
    one_by_one(True)

    assert found == outcome(text)
    assert isinstance(found, str)


def test_lines_are_counted_through_runs():
    lines = MODEL.split("\n")
    for ends in ("\n", "\r\n", "\r"):
        bad = [*lines[:-1], lines[-1].replace('objectid="2"', 'objectid="9"')]
        assert f"line {len(lines)}: places object 9" in outcome(
            ends.join(bad).replace("\r\r", "\r")
        )


def test_ends_of_pieces_are_ends_of_tags():
    text = MODEL.encode()
    pieces = [text[a:b] for a, b in pairwise([*range(0, len(text), 50), len(text)])]

    cut = list(plain_runs.cut_at_ends(pieces))

    assert b"".join(cut) == text
    assert all(piece.endswith(b">") for piece in cut if piece)


@pytest.mark.parametrize("word", ["0" * 12 + "1", "0" * 5000 + "1"])
def test_zeros_before_an_index_count_nothing(word):
    text = MODEL.replace('v2="1"', f'v2="{word}"')

    assert outcome(text) == outcome(MODEL)
