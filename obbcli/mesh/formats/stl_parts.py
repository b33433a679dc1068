"""The parts of an STL file: the solids of an ASCII file, by name."""

from __future__ import annotations

import re
from functools import partial
from typing import TYPE_CHECKING

from obbcli.mesh.formats.stl import TITLE, is_binary_stl, read_stl, without_remarks
from obbcli.mesh.formats.text import strip_mark
from obbcli.mesh.parts.placed import rows_of, runs_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.mesh.parts.placed import PlacedPart, Run
    from obbcli.mesh.source import Source

_FACET = re.compile(rb"(?i)\bfacet\s+normal\b")
_NAME = re.compile(rb"(?i)solid\s*")


def parts_stl(source: Source) -> Iterator[PlacedPart]:
    """Yield the solids of an ASCII file, or the whole of a binary one, without a name.

    Raises:
        MeshError: as `read_stl`, which all of the file goes through.
    """
    arrays = read_stl(source)
    binary = is_binary_stl(source.data)
    runs = [("", len(arrays[1]))] if binary else _runs(without_remarks(strip_mark(source.data)))
    yield from runs_of(partial(rows_of, arrays), runs)


def _runs(text: bytes) -> list[Run]:
    """Return the name and facet count of each solid."""
    runs: list[Run] = []
    name, start = "", 0
    for match in re.finditer(TITLE, text, re.IGNORECASE):
        ends = text[match.start() - 3 : match.start()].lower() == b"end"
        title = match.start() - 3 * ends
        opens_line = max(text.rfind(end, start, title) for end in (b"\n", b"\r")) + 1
        if text[max(opens_line, start) : title].strip():
            continue
        runs.append((name, len(_FACET.findall(text, start, title))))
        name = "" if ends else _NAME.sub(b"", match[0], count=1).strip().decode("utf-8", "replace")
        start = match.end()
    return [*runs, (name, len(_FACET.findall(text, start)))]
