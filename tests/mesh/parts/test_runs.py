"""Parts of OBJ and STL, which are runs of faces, and files of formats without parts."""

from __future__ import annotations

import pytest
from claims.parts import require_whole
from mesh_files.plain_files import FILES

from obbcli import load_parts

TRIANGLE = b"v 0 0 0\nv 1 0 0\nv 0 1 0\n"
FACET = b"facet normal 0 0 1\nouter loop\nvertex 0 0 %d\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
FACET += b"endfacet\n"


def written(tmp_path, name, data):
    path = tmp_path / name
    path.write_bytes(data)
    return path


def paths_of(path):
    return [part.path for part in load_parts(path)]


OBJ = b"""f 1 2 3
o frame
f 1 2 3
f 1 2 3 1 \\
2
g ignored
o arm#2 the second # a comment
o arm
f -3 -2 -1
o frame
usemtl x
f 1/1 2/1 3/1
"""


def test_objects_of_obj_are_parts_in_the_order_of_their_faces(tmp_path):
    path = written(tmp_path, "a.obj", TRIANGLE + OBJ)

    parts = load_parts(path).parts

    assert [(p.path, len(p.mesh.triangles)) for p in parts] == [
        *(("", 1), ("frame", 4), ("arm", 1), ("frame#2", 1)),
    ]
    assert {part.unit for part in parts} == {None}
    require_whole(path)


def test_groups_of_obj_are_parts_where_there_is_no_object(tmp_path):
    data = TRIANGLE + b"g a b\nf 1 2 3\ng\nf 1 2 3\ng wheel#2 # left\nf 3 2 1\n"
    path = written(tmp_path, "a.obj", data)

    assert paths_of(path) == ["a b", "", "wheel#2"]
    require_whole(path)


def test_solids_of_ascii_stl_are_parts(tmp_path):
    data = b"solid one\n" + FACET % 0 + FACET % 1 + b"endsolid one\nsolid empty\nendsolid\n"
    data += b"SOLID\n" + FACET % 2 + b"endsolid\n# solid no\nsolid facet normal\n" + FACET % 3
    path = written(tmp_path, "a.stl", data + b"end solid facet\n")

    assert [(p.path, len(p.mesh.triangles)) for p in load_parts(path)] == [
        *(("one", 2), ("", 1), ("facet normal", 1)),
    ]
    require_whole(path)


@pytest.mark.parametrize("place", range(len(FILES)), ids=list(FILES))
def test_every_plain_file_is_the_join_of_its_parts(tmp_path, place):
    suffix, data = list(FILES.values())[place]
    path = written(tmp_path, f"a{suffix}", data)

    require_whole(path)
    assert load_parts(path).parts[0].path in ("", "part")
