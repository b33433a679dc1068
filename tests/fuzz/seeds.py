"""Write the first inputs of the C++ fuzz targets: `python tests/fuzz/seeds.py`.

What fuzzers found later stands beside them under a name of its own.
"""

from __future__ import annotations

import struct
import sys
import tempfile
from pathlib import Path

import numpy as np

CORPUS = Path(__file__).parent / "corpus"
sys.path.insert(0, str(Path(__file__).parents[1]))

from meshes.nasty import bumpy_grid, needles, soup  # noqa: E402
from oracles.tree_files import FIXED  # noqa: E402

from obbcli import Mesh, ObbTree  # noqa: E402


def tree_file(data: bytes, leaf_size: int, placed: bytes) -> bytes:
    """Return a tree file as `fuzz_tree_file.cpp` takes it."""
    fields = FIXED.unpack_from(data)
    header_bytes, nodes, triangles, vertices, exponent = fields[2], *fields[6:10]
    head = struct.pack(
        "<BhBBBB", leaf_size - 1, exponent, triangles - 1, max(nodes - 1, 0), vertices, 0
    )
    return (
        head[: 4 if triangles == 1 else 7]
        + head[-2:] * (triangles == 1)
        + placed
        + (data[header_bytes:])
    )


def tree_files() -> dict[str, bytes]:
    """Return files of small trees in several places."""
    random = np.random.default_rng(0)
    seeds = {}
    surfaces = {"one": soup(1), "two": soup(2), "soup": soup(12), "grid": bumpy_grid(4)}
    surfaces["needles"] = needles(9)
    surfaces["blocks"] = soup(40)
    for name, surface in surfaces.items():
        for leaf_size in (1, 3):
            with tempfile.TemporaryDirectory() as folder:
                path = Path(folder) / "seed.obbt"
                ObbTree.build(Mesh(*surface), leaf_size=leaf_size).save(path)
                data = path.read_bytes()
            near = bytes(4) + struct.pack("<12h", 300, *random.integers(-900, 900, 11))
            turned = random.integers(0, 256, 4 + 24, dtype=np.uint8).tobytes()
            for place, placed in (("near", near), ("turned", turned)):
                seeds[f"{name}_{leaf_size}_{place}"] = tree_file(data, leaf_size, placed)
    return seeds


def shapes() -> dict[str, bytes]:
    """Return two triangles, velocities and boxes, on a grid and off it."""
    random = np.random.default_rng(1)
    seeds = {}
    for k in range(6):
        grid = random.integers(-24, 24, 60, dtype=np.int8).tobytes()
        seeds[f"grid_{k}"] = bytes([7]) + grid
        floats = random.normal(size=40).astype("<f8").tobytes()
        seeds[f"floats_{k}"] = bytes([4]) + floats
    return seeds


def motions() -> dict[str, bytes]:
    """Return small bodies in motion, one for each way of reading the bytes."""
    random = np.random.default_rng(2)
    kinds = (0, 1, 4, 8, 16, 32, 64, 0x78)
    seeds = {f"moderate_{k}": random.bytes(300) for k in kinds if k % 4 == 0}
    seeds |= {f"grid_{k}": random.bytes(180) for k in (1, 9, 17, 33)}
    seeds["wild_2"] = random.normal(size=60).astype("<f8").tobytes()
    return {name: bytes([int(name.rpartition("_")[2])]) + data[1:] for name, data in seeds.items()}


def boxes() -> dict[str, bytes]:
    """Return eight boxes in two frames, one for each way of reading the bytes."""
    random = np.random.default_rng(3)
    return {f"options_{k}": bytes([k]) + random.bytes(400) for k in range(16)}


def main() -> None:
    """Write them all."""
    targets = {"tree_file": tree_files(), "predicates": shapes(), "first_contact": motions()}
    targets["box_lanes"] = boxes()
    for target, seeds in targets.items():
        folder = CORPUS / target
        folder.mkdir(parents=True, exist_ok=True)
        for name, data in seeds.items():
            (folder / f"seed_{name}.bin").write_bytes(data)


if __name__ == "__main__":
    main()
