"""A tree file of many blocks, what of it was read, and how to damage it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from meshes.nasty import bumpy_grid
from oracles.tree_files import BLOCK, FIXED

import obbcli
from obbcli import Body, Mesh, Motion, ObbTree, Pose
from obbcli.tree.opened import OpenedTree

if TYPE_CHECKING:
    from pathlib import Path

AT_REST = Motion()
FAR = Pose(translation=(1000.0, 0.0, 0.0))


def save_sheet(path: Path) -> Path:
    """Return a file of some fifty blocks."""
    ObbTree.build(Mesh(*bumpy_grid(32))).save(path)
    return path


def loaded(tree: ObbTree) -> int:
    assert isinstance(tree._made, OpenedTree)
    return tree._made.loaded_bytes


def data_blocks(path: Path) -> range:
    """Return where the blocks of data begin in a file."""
    return range(FIXED.unpack_from(path.read_bytes())[2], path.stat().st_size, BLOCK)


def flip(path: Path, position: int) -> None:
    data = bytearray(path.read_bytes())
    data[position] ^= 64
    path.write_bytes(data)


def touch_all(path: Path) -> None:
    """Ask what leaves nothing unread."""
    tree = ObbTree.open(path)
    obbcli.triangle_pairs(tree, ObbTree.build(Mesh(*bumpy_grid(32)), max_depth=0))


def far_apart(tree: ObbTree) -> bool:
    return not obbcli.collide(tree, Body(tree, pose=FAR)).collides
