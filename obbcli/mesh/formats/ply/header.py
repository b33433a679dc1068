"""The header of a PLY file, parsed strictly before a byte of its body is believed."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from obbcli.mesh.formats.text import shown, whole

if TYPE_CHECKING:
    from obbcli.mesh.source import Source

_TYPES = {
    **dict.fromkeys((b"char", b"int8"), "i1"),
    **dict.fromkeys((b"uchar", b"uint8"), "u1"),
    **dict.fromkeys((b"short", b"int16"), "i2"),
    **dict.fromkeys((b"ushort", b"uint16"), "u2"),
    **dict.fromkeys((b"int", b"int32"), "i4"),
    **dict.fromkeys((b"uint", b"uint32"), "u4"),
    **dict.fromkeys((b"int64",), "i8"),
    **dict.fromkeys((b"uint64",), "u8"),
    **dict.fromkeys((b"float", b"float32"), "f4"),
    **dict.fromkeys((b"double", b"float64"), "f8"),
}
_FORMATS = {b"ascii": "", b"binary_little_endian": "<", b"binary_big_endian": ">"}
_LINE = re.compile(rb"([^\r\n]*)(\r\n|\n|\r)")


@dataclass(frozen=True)
class Property:
    """Holds one property: its value's type, and the type of its length where it is a list."""

    name: str
    kind: np.dtype[np.generic]
    count_kind: np.dtype[np.generic] | None = None

    @property
    def least_size(self) -> int:
        """Return the fewest bytes a row of it takes in a binary body."""
        return (self.count_kind or self.kind).itemsize


@dataclass
class Element:
    """Holds one element: its name, how many rows are claimed, and its properties in order."""

    name: str
    count: int
    line: int
    properties: list[Property] = field(default_factory=list)

    @property
    def has_lists(self) -> bool:
        """Return whether a row's size depends on its contents."""
        return any(p.count_kind is not None for p in self.properties)


@dataclass(frozen=True)
class Header:
    """Holds what a header says and where the body begins.

    Args:
        order: `<` or `>` for binary bodies, empty for ASCII.
        elements: in the body's order.
        body: the offset of the body's first byte.
        line: the number of the body's first line.
    """

    order: str
    elements: list[Element]
    body: int
    line: int


def read_header(source: Source) -> Header:
    """Return the parsed header.

    Raises:
        MeshError: it does not begin or end, or a line of it is not understood; with the line.
    """
    if not re.match(rb"ply[ \t]*[\r\n]", source.data):
        raise source.error("does not begin with a line 'ply'", at="1")
    order = ""
    elements: list[Element] | None = None
    for line, match in enumerate(_LINE.finditer(source.data), start=1):
        words = match[1].split()
        keyword = words[0] if words else b"comment"
        if keyword == b"format":
            order, elements = _format(source, words, line), []
        elif line == 1 or keyword in (b"comment", b"obj_info"):
            continue
        elif elements is None:
            raise source.error("expected a line 'format' first", at=str(line))
        elif keyword == b"end_header":
            return Header(order, elements, match.end(), line + 1)
        else:
            _declare(source, words, line, order, elements)
    raise source.error("the header does not end", "the file was cut short")


def _declare(
    source: Source, words: list[bytes], line: int, order: str, elements: list[Element]
) -> None:
    """Add the element or property of one line to `elements`."""
    if words[0] == b"element":
        elements.append(_element(source, words, line, elements))
    elif words[0] == b"property" and elements:
        elements[-1].properties.append(_property(source, words, line, order, elements[-1]))
    else:
        raise source.error(f"'{shown(words[0])}' is out of place in a PLY header", at=str(line))


def _format(source: Source, words: list[bytes], line: int) -> str:
    """Return the byte order that a `format` line names."""
    if len(words) != 3 or words[1] not in _FORMATS:
        raise source.error(
            "unknown format",
            "ascii, binary_little_endian and binary_big_endian are read",
            at=str(line),
        )
    return _FORMATS[words[1]]


def _element(source: Source, words: list[bytes], line: int, before: list[Element]) -> Element:
    """Return the element that a line declares."""
    if len(words) != 3:
        raise source.error("expected 'element NAME COUNT'", at=str(line))
    count = whole(source, words[2], line, "count")
    name = words[1].decode("latin-1")
    if count < 0:
        raise source.error(
            f"element {shown(words[1])} has the negative count {count}", at=str(line)
        )
    if any(element.name == name for element in before):
        raise source.error(f"element {shown(words[1])} is declared twice", at=str(line))
    return Element(name, count, line)


def _property(
    source: Source, words: list[bytes], line: int, order: str, element: Element
) -> Property:
    """Return the property that a line declares."""
    is_list = len(words) == 5 and words[1] == b"list"
    kinds = words[2:4] if is_list else words[1:2]
    if (not is_list and len(words) != 3) or any(kind not in _TYPES for kind in kinds):
        raise source.error("expected 'property [list TYPE] TYPE NAME' of known types", at=str(line))
    types = [np.dtype(order + _TYPES[kind]) for kind in kinds]
    if is_list and types[0].kind == "f":
        raise source.error("a list's length must be of a whole type", at=str(line))
    name = words[-1].decode("latin-1")
    if any(prop.name == name for prop in element.properties):
        raise source.error(f"property {shown(words[-1])} is declared twice", at=str(line))
    return Property(name, types[-1], types[0] if is_list else None)
