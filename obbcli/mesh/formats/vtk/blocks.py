"""VTK's index of blocks (`.vtm`): the files that it names, at or below its folder, in its order."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple
from xml.parsers import expat

from obbcli.mesh.formats.text import counted, shown
from obbcli.mesh.parts.placed import joined
from obbcli.mesh.source import Source

if TYPE_CHECKING:
    from collections.abc import Callable

    from obbcli.mesh.source import MeshArrays

_GROUPS = ("vtkMultiBlockDataSet", "Block", "Piece")
#: What may stand in what; values of the index itself are passed over.
_INSIDE = {
    "": {"VTKFile"},
    "VTKFile": {"vtkMultiBlockDataSet", "FieldData"},
    **{name: {"Block", "Piece", "DataSet", "FieldData"} for name in _GROUPS},
}


class BlockFile(NamedTuple):
    """One file that an index names.

    Attributes:
        path: names from the outermost block down, or numbers where a block has no name.
        file: as it is written.
        line: where.
    """

    path: tuple[str, ...]
    file: str
    line: int


def block_files(source: Source) -> list[BlockFile]:
    """Return the files that an index names, in its order.

    Raises:
        MeshError: no whole XML, or an element that is not understood.
    """
    if b"<!DOCTYPE" in source.data or b"<!ENTITY" in source.data:
        raise source.error("declares a document type", "remove the <!DOCTYPE ...>")
    walk = _Walk(source)
    try:
        walk.parser.Parse(source.data, True)
    except expat.ExpatError as fault:
        words = expat.ErrorString(fault.code) if fault.code else "no XML"
        remedy = "it was cut short or damaged"
        raise source.error(f"is no whole XML: {words}", remedy, at=str(fault.lineno)) from fault
    return walk.files


class _Walk:
    """Goes through the elements of an index."""

    def __init__(self, source: Source) -> None:
        self._source = source
        self._elements: list[str] = []
        self._names: list[str] = []
        self.files: list[BlockFile] = []
        self.parser = expat.ParserCreate()
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        line = self.parser.CurrentLineNumber
        parent = self._elements[-1] if self._elements else ""
        self._elements.append(name)
        self._names.append(attributes.get("name") or attributes.get("index", ""))
        if "FieldData" in self._elements[:-1]:
            return
        if name not in _INSIDE.get(parent, ()):
            fault = f"<{shown(name.encode())}> is nothing that <{parent or 'the file'}> has"
            raise self._source.error(fault, "export the blocks as .vtu or .vtp", at=str(line))
        if name == "DataSet" and attributes.get("file"):
            self.files.append(BlockFile(tuple(self._names[2:]), attributes["file"], line))

    def _end(self, _name: str) -> None:
        self._elements.pop()
        self._names.pop()


def read_blocks(source: Source, read: Callable[[Source], MeshArrays]) -> MeshArrays:
    """Return points and triangles of all files that an index names, one after the other.

    Args:
        source: the index.
        read: reads one of its files.

    Raises:
        MeshError: a file lies elsewhere, cannot be read or is refused; or no file is named.
    """
    blocks = Blocks(source, read)
    found = [blocks.of(block) for block in blocks.files]
    # Those without triangles are no parts of the file.
    count = sum(len(triangles) > 0 for _, triangles in found)
    if count > 1:
        source.note(f"{counted(count, 'block')} taken as one surface")
    return joined(found, source)


class Blocks:
    """Reads the files that an index names, each once.

    Args:
        source: the index, which is given their notes.
        read: reads one of its files.

    Attributes:
        files: those that it names, in its order.

    Raises:
        MeshError: as `block_files`, or it names none.
    """

    def __init__(self, source: Source, read: Callable[[Source], MeshArrays]) -> None:
        self._source = source
        self._read = read
        self._found: dict[str, MeshArrays] = {}
        self.files = block_files(source)
        if not self.files:
            remedy = "a mesh is a surface of triangles"
            raise source.error("is an index that names no files", remedy)

    def of(self, block: BlockFile) -> MeshArrays:
        """Return points and triangles of a file.

        Raises:
            MeshError: it lies elsewhere, cannot be read or is refused.
        """
        if block.file not in self._found:
            part = block_source(self._source, block)
            self._found[block.file] = self._read(part)
            for note in part.notes:
                self._source.note(f"{part.name}: {note}")
        return self._found[block.file]


def block_source(source: Source, block: BlockFile) -> Source:
    """Return a file that an index names, read.

    Raises:
        MeshError: it lies elsewhere, or cannot be read.
    """
    line = str(block.line)
    words = block.file.replace("\\", "/").split("/")
    if source.path is None:
        fault = f"names the file '{shown(block.file.encode())}'"
        raise source.error(fault, "name the index instead of a stream", at=line)
    if ":" in block.file or not words[0] or ".." in words:
        fault = f"names '{shown(block.file.encode())}', which is not at or below its folder"
        raise source.error(fault, "put it beside the index", at=line)
    path = source.path.parent / "/".join(words)
    try:
        data = path.read_bytes()
    except (OSError, ValueError) as fault:
        reason = getattr(fault, "strerror", None) or "no name of a file"
        what = f"names '{shown(block.file.encode())}', which cannot be read: {reason}"
        raise source.error(what, "put that file beside the index", at=line) from fault
    return Source(str(path), path.name, data, path)
