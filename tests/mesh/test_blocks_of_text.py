"""Text that is read block by block: where blocks end changes nothing of what is read or said."""

from __future__ import annotations

import pytest
from mesh.test_mixed_faces import OBJ, outcome

from obbcli.mesh.formats import stl
from obbcli.mesh.formats.obj import reader as obj_reader

FACET = (
    "facet normal 0 0 1\n outer loop\n  vertex {0} 0 0\n  vertex 1 {0} 0\n  vertex 0 1 {0}\n"
    " endloop\nendfacet\n"
)
STL = (
    "solid endfacet\n"
    + "".join(FACET.format(k) for k in range(9))
    + "endsolid\nsolid b\n"
    + "".join(FACET.format(k + 0.5) for k in range(9))
    + "endsolid b\n"
)
#: What may stand in place of a word, glued to it or beside it.
ODD = ["", "endfacet", "x", "1_0", "nan", "7 7", "endsolid", "solid x", "# a", "\f", "\r"]


@pytest.mark.parametrize("odd", ODD)
@pytest.mark.parametrize("size", [1, 50, 300])
def test_facets_are_those_of_the_whole_text(monkeypatch, odd, size):
    places = [k for k in range(len(STL)) if STL[k] in " \n"][len(odd) % 5 :: 5]
    texts = [STL[:k] + glue + odd + STL[k:] for k in places for glue in ("", " ")]
    whole = [outcome(text.encode(), ".stl") for text in texts]

    monkeypatch.setattr(stl, "_BLOCK", size)

    assert [outcome(text.encode(), ".stl") for text in texts] == whole


@pytest.mark.parametrize("size", [1, 2, 4])
def test_statements_are_those_of_the_whole_text(monkeypatch, size):
    lines = OBJ.splitlines(keepends=True)
    texts = ["".join([*lines[:k], odd, *lines[k:]]) for odd in ODD for k in range(len(lines))]
    texts += [OBJ.replace("v 1 0 0", "v 1 0 0 0.5 0.5 0.5"), OBJ]
    whole = [outcome(text.encode(), ".obj") for text in texts]

    monkeypatch.setattr(obj_reader, "_LINES", size)

    assert [outcome(text.encode(), ".obj") for text in texts] == whole
