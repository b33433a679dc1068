"""Damaged tree files are refused, or at worst answer from what they hold; they never crash."""

from __future__ import annotations

import json
import struct
import zlib
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from meshes.nasty import bumpy_grid, soup
from oracles import tree_files as tree_oracles
from oracles.tree_files import FIXED

from obbcli import Mesh, ObbTree, TreeFileError
from obbcli.tree.whole import WholeTree

if TYPE_CHECKING:
    from pathlib import Path

FIELDS = (
    "magic",
    "version",
    "header_bytes",
    "crc",
    "block_bytes",
    "file_bytes",
    "boxes",
    "triangles",
    "vertices",
    "exponent",
    "text_bytes",
)


def file_of(surface: Any, folder: Path, **options: Any) -> bytes:
    path = folder / "made.obbt"
    ObbTree.build(Mesh(*surface), **options).save(path)
    return path.read_bytes()


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    return file_of(soup(3), tmp_path_factory.mktemp("small"))


def with_field(data: bytes, name: str, value: Any) -> bytes:
    """Return the bytes with one field of the fixed header changed and all checksums made to fit."""
    fields = list(FIXED.unpack_from(data))
    fields[FIELDS.index(name)] = value
    return _resealed(FIXED.pack(*fields) + data[FIXED.size :])


def _resealed(data: bytes) -> bytes:
    """Return the bytes with a header checksum that fits, whatever the header claims."""
    header_bytes = FIXED.unpack_from(data)[2]
    if header_bytes > len(data):
        return data
    sealed = bytearray(data)
    crc = zlib.crc32(data[20:header_bytes], zlib.crc32(data[:16]))
    struct.pack_into("<I", sealed, 16, crc)
    return bytes(sealed)


def with_description(data: bytes, **changes: Any) -> bytes:
    """Return the bytes with another description of the same length, padded by blanks."""
    text_bytes = FIXED.unpack_from(data)[-1]
    fields = json.loads(data[FIXED.size : FIXED.size + text_bytes])
    for name, value in changes.items():
        fields[name] = value
    text = json.dumps(fields, separators=(",", ":")).encode().ljust(text_bytes)
    assert len(text) == text_bytes
    return _resealed(data[: FIXED.size] + text + data[FIXED.size + text_bytes :])


def test_treefile_rejects_every_truncation(small: bytes) -> None:
    for length in range(len(small)):
        for verify in (True, False):
            with pytest.raises(TreeFileError):
                ObbTree.from_bytes(small[:length], verify=verify)


@pytest.mark.parametrize("extra", [1, 4, 64, 4096])
def test_treefile_rejects_extra_bytes(extra: int, small: bytes) -> None:
    for verify in (True, False):
        with pytest.raises(TreeFileError, match="bytes long, its header says"):
            ObbTree.from_bytes(small + bytes(extra), verify=verify)


def test_treefile_rejects_every_flipped_byte(small: bytes) -> None:
    random = np.random.default_rng(0)
    header_bytes = FIXED.unpack_from(small)[2]
    for position in range(len(small)):
        flipped = bytearray(small)
        flipped[position] ^= int(random.integers(1, 256))
        with pytest.raises(TreeFileError):
            ObbTree.from_bytes(bytes(flipped))
        if position < header_bytes:
            with pytest.raises(TreeFileError):
                ObbTree.from_bytes(bytes(flipped), verify=False)


def test_treefile_rejects_every_flipped_bit_of_the_header(small: bytes) -> None:
    for position in range(FIXED.size):
        for bit in range(8):
            flipped = bytearray(small)
            flipped[position] ^= 1 << bit
            with pytest.raises(TreeFileError):
                ObbTree.from_bytes(bytes(flipped), verify=False)


@pytest.mark.parametrize(
    "head", [b"", b"\x89OBBT\r\n\x1a", b"solid cube\nfacet", b"\x89OBBT\n\x1a\n", b"\x00" * 200]
)
def test_treefile_rejects_what_is_no_tree_file(head: bytes) -> None:
    with pytest.raises(TreeFileError, match="is not a tree file"):
        ObbTree.from_bytes(head)


@pytest.mark.parametrize("version", [0, 2, 2**32 - 1])
def test_treefile_rejects_another_version_and_names_both(version: int, small: bytes) -> None:
    with pytest.raises(TreeFileError, match=f"of version {version}, this obbtree reads version 1"):
        ObbTree.from_bytes(with_field(small, "version", version))


@pytest.mark.parametrize(
    ("name", "value"),
    [
        (name, value)
        for name in ("boxes", "triangles", "vertices", "file_bytes")
        for value in (0, 1, 2**31, 2**32, 2**58, 2**63, 2**64 - 1)
    ]
    + [
        (name, value)
        for name in ("header_bytes", "block_bytes")
        for value in (0, 63, 64, 2**32 - 1)
    ]
    + [("text_bytes", value) for value in (0, 1, 2**31, 2**32 - 1)]
    + [("exponent", value) for value in (-(2**31), -1101, 1101, 2**31 - 1)],
)
def test_treefile_rejects_a_lying_field_under_a_fitting_checksum(
    name: str, value: int, small: bytes
) -> None:
    forged = with_field(small, name, value)
    for verify in (True, False):
        with pytest.raises(TreeFileError):
            ObbTree.from_bytes(forged, verify=verify)


@pytest.mark.parametrize(
    "text", [b"", b"[]", b"null", b"{}", b"{", b'"fit"', b"\xff\xfe", b"[" * 100, b"1e999", b"NaN"]
)
def test_treefile_rejects_a_description_that_is_none(text: bytes, small: bytes) -> None:
    text_bytes = FIXED.unpack_from(small)[-1]
    end = FIXED.size + text_bytes
    forged = _resealed(small[: FIXED.size] + text.ljust(text_bytes) + small[end:])

    with pytest.raises(TreeFileError, match="description"):
        ObbTree.from_bytes(forged)


@pytest.mark.parametrize(
    "changes",
    [
        {"fit": 5},
        {"split": None},
        {"leaf_size": "1"},
        {"leaf_size": True, "split": "med"},
        {"max_depth": 1.5},
        {"max_depth": False, "fit": "t"},
        {"source": 1},
    ],
    ids=repr,
)
def test_treefile_rejects_a_description_with_a_field_of_another_kind(
    changes: dict[str, Any], small: bytes
) -> None:
    with pytest.raises(TreeFileError, match="lacks something in its description"):
        ObbTree.from_bytes(with_description(small, **changes))


@pytest.mark.parametrize(
    "changes",
    [
        {"leaf_size": 0},
        {"leaf_size": -1},
        {"leaf_size": -(10**30)},
        {"max_depth": -5},
        {"fit": "x"},
        {"split": ""},
        {"unit": "m\x1b"},
        {"parts": ["all"]},
        {"parts": [["a", 0]]},
        {"parts": [["a", 0, 2]]},
        {"parts": [["a", 0, 4]]},
        {"parts": [["a", 1, 2]]},
        {"parts": [["a", 0, 4], ["b", 4, -1]]},
        {"parts": [["a", 0, 1], ["b", 0, 2]]},
        {"parts": [["a\n", 0, 3]]},
        {"parts": [["a", 0.0, 3]]},
        {"parts": [["a", False, 3]]},
    ],
    ids=repr,
)
def test_treefile_rejects_a_description_that_no_build_has(
    changes: dict[str, Any], tmp_path: Path
) -> None:
    (name,) = changes
    path = tmp_path / "forged.obbt"
    arrays = ObbTree.build(Mesh(*soup(3)))._arrays
    ObbTree(WholeTree(replace(arrays, description=replace(arrays.description, **changes)))).save(
        path
    )

    for verify in (True, False):
        with pytest.raises(TreeFileError, match=f"says that {name} is "):
            ObbTree.open(path, verify=verify)


@pytest.mark.parametrize(
    "changes",
    [
        {"bounds": []},
        {"bounds": [[0.0, 0.0, 0.0]]},
        {"bounds": [[0.0, 0.0], [1.0, 1.0]]},
        {"bounds": [0.0, 1.0]},
        {"bounds": [[0, 0, 0], [1, 1, 1]]},
        {"bounds": [["", "", ""], ["z", "z", "z"]]},
        {"bounds": [[9.0, 9.0, 9.0], [-9.0, -9.0, -9.0]]},
        {"bounds": [[-9.0, -9.0, -9.0], [9.0, 9.0, float("inf")]]},
        {"bounds": [[-9.0, -9.0, float("-inf")], [9.0, 9.0, 9.0]]},
        {"bounds": [[-9.0, -9.0, float("nan")], [9.0, 9.0, 9.0]]},
        {"surface_centroid": [0.0]},
        {"surface_centroid": [None, 0.0, 0.0]},
        {"surface_centroid": [float("nan"), 0.0, 0.0]},
        {"surface_centroid": [50.0, 0.0, 0.0]},
    ],
    ids=repr,
)
def test_treefile_rejects_a_surface_that_no_mesh_has(changes: dict[str, Any], small: bytes) -> None:
    with pytest.raises(TreeFileError, match="says of its surface what no mesh has"):
        ObbTree.from_bytes(with_description(small, **changes))


@pytest.mark.parametrize("name", ["bounds", "surface_centroid"])
def test_check_refuses_a_surface_that_is_another(name: str, tmp_path: Path) -> None:
    path = tmp_path / "forged.obbt"
    data = file_of(([[0, 0, 0], [9, 0, 0], [0, 9, 0]], [[0, 1, 2]]), tmp_path)
    value = {"bounds": [[0.0, 0.0, 0.0], [9.0, 9.0, 1.0]], "surface_centroid": [3.0, 4.0, 0.0]}
    path.write_bytes(with_description(data, **{name: value[name]}))

    for tree in (ObbTree.open(path), ObbTree.from_bytes(path.read_bytes())):
        with pytest.raises(TreeFileError, match="the surface has other bounds"):
            tree.check()


def test_checksum_error_names_the_block(tmp_path: Path) -> None:
    data = bytearray(file_of(bumpy_grid(10), tmp_path))
    start = FIXED.unpack_from(data)[2]
    data[start + 5000] ^= 1

    with pytest.raises(TreeFileError, match=f"between bytes {start + 4096} and {start + 8192}"):
        ObbTree.from_bytes(bytes(data), "sheet.obbt")


def test_fields_of_the_format_are_those_of_the_oracle(small: bytes) -> None:
    assert len(FIELDS) == len(FIXED.unpack_from(small))
    assert tree_oracles.parse(small).description["leaf_size"] == 1
