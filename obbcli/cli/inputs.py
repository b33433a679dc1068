"""Where shapes come from: a mesh file, a tree file, or either of them on standard input."""

from __future__ import annotations

import sys
import time
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from obbcli.cli.boundary import UsageError
from obbcli.cli.progress import bar
from obbcli.errors import MeshError
from obbcli.files import file_and_pattern, file_of, is_device, is_large_file, stamp_of
from obbcli.report.record import Source, file_sha256
from obbcli.threads import both

if TYPE_CHECKING:
    from collections.abc import Iterable

    from obbcli.cli.lengths import Lengths
    from obbcli.mesh import Mesh
    from obbcli.tree.tree import ObbTree

STDIN = "-"
_STDIN_NAME = "<stdin>"


class Input(NamedTuple):
    """A shape that was read.

    Attributes:
        name: as the user wrote it; `-` for standard input.
        tree: its tree.
        sha256: of the bytes read, where they are known already.
        seconds: s of wall time that reading and building took.
        stamp: of the file before it was read; None where it is no file.
        remarks: what is said of it beside the notes of its mesh.
    """

    name: str
    tree: ObbTree
    sha256: str | None
    seconds: float
    stamp: tuple[int, ...] | None = None
    remarks: tuple[str, ...] = ()

    def source(self, *, with_sha256: bool) -> Source:
        """Return what a record says of it.

        Raises:
            ObbError: the file is not what it was when it was read.
            OSError: the file is gone.
        """
        digest = self.sha256
        if with_sha256 and digest is None:
            digest = file_sha256(file_of(self.name), self.stamp)
        source = Source.of(self.name, digest, self.tree)
        return source._replace(notes=(*source.notes, *self.remarks))


class Piped(NamedTuple):
    """What standard input or a pipe brought.

    Attributes:
        data: all of it.
        suffix: of the pipe's name, where it is a format's; else the bytes must tell.
        place: what errors call it.
    """

    data: bytes
    suffix: str | None
    place: str


def keep_inputs(output: Path | None, names: Iterable[str]) -> None:
    """Refuse to write an output over an input.

    Raises:
        UsageError: `output` is one of the files, under whatever name.
    """
    if output is None or not output.is_file():
        return
    for name in names:
        file = file_of(name)
        if name != STDIN and Path(file).is_file() and output.samefile(file):
            fault = f"is the input {file}, which would be lost"
            raise UsageError(f"-o {output}", fault, "write to another file")


def read_pair(
    a: str,
    b: str,
    lengths: tuple[Lengths | None, Lengths | None] = (None, None),
    *,
    verify: bool,
    hashed: bool,
    progress: bool,
) -> tuple[Input, Input]:
    """Return A and B as `read` does; one of them may be standard input.

    Two large files are read at the same time, and their root boxes made, which any question needs.

    Raises:
        UsageError: both are.
    """
    if a == b == STDIN:
        raise UsageError("B", "is standard input, and so is A", "name a file for one of them")
    if lengths[0] is not None and lengths[0].sag is not None:
        from obbcli.cli.lengths import shared_sag

        lengths = shared_sag((a, b), lengths)
    if a == b and lengths[0] == lengths[1]:
        first = read(a, lengths[0], verify=verify, hashed=hashed, progress=progress)
        return first, first
    at_once = is_large_file(a) and is_large_file(b)
    one = partial(read, verify=verify, hashed=hashed, roots=at_once)
    # No more than one bar is drawn at a time.
    return both(
        partial(one, a, lengths[0], progress=progress),
        partial(one, b, lengths[1], progress=progress and not at_once),
        at_once=at_once,
    )


def read(
    name: str,
    lengths: Lengths | None = None,
    *,
    verify: bool,
    hashed: bool,
    progress: bool,
    roots: bool = False,
) -> Input:
    """Return a mesh or tree file with its tree, which is built over a mesh.

    Args:
        name: a path, or `-` for standard input.
        lengths: what becomes of its coordinates.
        verify: whether a tree file's checksums are compared.
        hashed: whether the SHA-256 of what is read will be asked for.
        progress: whether a bar may be drawn.
        roots: whether the root box of a tree that is built is made at once.

    Raises:
        MeshError: the mesh cannot be read or is refused.
        TreeFileError: the tree file is damaged.
        OSError: the file cannot be read.
    """
    from obbcli.mesh import Mesh
    from obbcli.tree.tree import ObbTree

    start = time.perf_counter()
    stamp = stamp_of(file_of(name))
    sag = None if lengths is None else lengths.sag
    shape, sha256 = read_shape(name, verify=verify, hashed=hashed, sag=sag)
    if lengths is not None:
        shape = lengths.measured(shape, name)
    if isinstance(shape, Mesh):
        with bar(f"building over {name}", len(shape.triangles), wanted=progress) as move:
            shape = ObbTree.build(shape, progress=move)
        shape = shape.with_root() if roots else shape
    remarks = () if lengths is None else lengths.remarks
    return Input(name, shape, sha256, time.perf_counter() - start, stamp, remarks)


def read_shape(
    name: str, *, verify: bool, hashed: bool = True, sag: float | None = None
) -> tuple[Mesh | ObbTree, str | None]:
    """Return what a file or standard input holds, and the SHA-256 of its bytes where it is known.

    Args:
        name: a path, `FILE#PATTERN`, or `-` for standard input.
        verify: whether a tree file's checksums are compared.
        hashed: whether the SHA-256 of a mesh or a stream is found; that of a tree file is not.
        sag: how far triangles may be from exact surfaces of a mesh file; None: the default.

    Raises:
        MeshError: the mesh cannot be read or is refused.
        TreeFileError: the tree file is damaged.
        OSError: the file cannot be read.
    """
    from obbcli.mesh import check_file, load_mesh
    from obbcli.tree.tree import ObbTree

    piped = read_piped(name)
    if piped is not None:
        return _from_bytes(piped, verify=verify, hashed=hashed, sag=sag)
    file, pattern = file_and_pattern(name)
    path = Path(file)
    check_file(path)
    if pattern is not None:
        mesh = _selected(path, pattern, hashed=hashed, sag=sag)
        return mesh, mesh.sha256
    if _is_tree(path):
        return ObbTree.open(name, verify=verify), None
    mesh = load_mesh(name, hashed=hashed, sag=sag)
    return mesh, mesh.sha256


def _selected(path: Path, pattern: str, *, hashed: bool, sag: float | None) -> Mesh:
    """Return the parts of a mesh file that a pattern takes, as one mesh."""
    from obbcli.mesh.parts.load import load_selection

    if path.is_fifo() or _is_tree(path):
        fault = f"has no parts to take '{pattern}' from"
        remedy = "build a tree of the parts: obbtree build 'MESH#PATTERN' -o FILE"
        raise MeshError(str(path), fault, "name a file" if path.is_fifo() else remedy)
    return load_selection(path, pattern, hashed=hashed, sag=sag)


def read_piped(name: str) -> Piped | None:
    """Return what standard input or a pipe brings; None where `name` is a file's.

    Raises:
        MeshError: nothing can be read from there, or it brings too much.
        OSError: it cannot be read.
    """
    from obbcli.mesh import known_suffixes, read_stream, suffix_of

    if name == STDIN:
        return Piped(read_stdin(), None, _STDIN_NAME)
    path = Path(name)
    if not path.is_fifo():
        return None
    with path.open("rb") as pipe:
        data = read_stream(pipe, name)
    suffix = suffix_of(path.name)
    return Piped(data, suffix if suffix in known_suffixes() else None, name)


def _from_bytes(
    piped: Piped, *, verify: bool, hashed: bool, sag: float | None
) -> tuple[Mesh | ObbTree, str | None]:
    """Return what a stream held."""
    from obbcli.mesh import digest_of, load_mesh_bytes
    from obbcli.tree.header import is_tree_file
    from obbcli.tree.tree import ObbTree

    if is_tree_file(piped.data):
        tree = ObbTree.from_bytes(piped.data, piped.place, verify=verify)
        return tree, digest_of(piped.data)() if hashed else None
    mesh = load_mesh_bytes(piped.data, piped.suffix, name=piped.place, hashed=hashed, sag=sag)
    return mesh, mesh.sha256


def _is_tree(path: Path) -> bool:
    """Return whether a file is a tree, told by its name's suffix or by its first bytes."""
    from obbcli.tree.header import MAGIC, is_tree_file

    if path.suffix.lower() == ".obbt":
        return True
    try:
        with path.open("rb") as file:
            return is_tree_file(file.read(len(MAGIC)))
    except OSError:
        # Left to the mesh's reader, who says it better.
        return False


def read_stdin() -> bytes:
    """Return all of standard input.

    Raises:
        MeshError: it is a terminal, another device or closed, or brings too much.
        OSError: it cannot be read.
    """
    from obbcli.mesh import read_stream

    if sys.stdin is None or is_device(sys.stdin):
        raise MeshError(_STDIN_NAME, "is no file or pipe", "pipe a mesh into it, or name a file")
    return read_stream(sys.stdin.buffer, _STDIN_NAME)
