"""Small files of every format that our own readers take: each is the join of its parts."""

from __future__ import annotations

import pytest
from claims.parts import require_whole
from mesh_files.collada_files import COLLADA_SEEDS
from mesh_files.deck_files import DECKS
from mesh_files.gltf_documents import instanced, morphing, skinned
from mesh_files.nastran_decks import SEEDS
from mesh_files.threemf_files import THREEMF_SEEDS

from obbcli import MeshError, load_mesh, load_parts

FILES = [
    *DECKS,
    *((".dae", data) for data in COLLADA_SEEDS),
    *((".3mf", data) for data in THREEMF_SEEDS),
    *((".bdf", text.encode()) for text in SEEDS),
    (".glb", morphing([1, 0.5]).glb()),
    (".glb", skinned(sets=2).glb()),
    (".glb", instanced(TRANSLATION=[[0, 0, 1], [0, 0, 2]]).glb()),
]


@pytest.mark.parametrize("place", range(len(FILES)))
def test_file_is_the_join_of_its_parts_or_both_are_refused_alike(tmp_path, place):
    suffix, data = FILES[place]
    path = tmp_path / f"a{suffix}"
    path.write_bytes(data)

    refused = [fault_of(load_mesh, path), fault_of(decode, path)]

    assert refused[0] == refused[1]
    if refused[0] is None:
        require_whole(path)


def decode(path):
    return [part.mesh for part in load_parts(path)]


def fault_of(read, path):
    """Return what a file is refused for; None where it is read."""
    try:
        read(path)
    except MeshError as fault:
        return str(fault)
    return None
