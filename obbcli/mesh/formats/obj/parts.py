"""The parts of an OBJ file: runs of faces below one `o` statement, or `g` where no `o` stands."""

from __future__ import annotations

import re
from functools import partial
from typing import TYPE_CHECKING

from obbcli.mesh.formats.obj.reader import read_obj
from obbcli.mesh.formats.obj.statements import statements
from obbcli.mesh.formats.text import strip_mark
from obbcli.mesh.parts.placed import rows_of, runs_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.mesh.parts.placed import PlacedPart, Run
    from obbcli.mesh.source import Source

#: Some names hold the sign itself.
_COMMENT = re.compile(rb"\s#.*")


def parts_obj(source: Source) -> Iterator[PlacedPart]:
    """Yield the file's parts; a name that comes again opens another part.

    Raises:
        MeshError: as `read_obj`, which all of the file goes through.
    """
    yield from runs_of(partial(rows_of, read_obj(source)), _runs(source))


def _runs(source: Source) -> list[Run]:
    """Return the name and triangle count of each run of faces."""
    lines = strip_mark(source.data).splitlines()
    found = list(statements(source.data))
    opens = b"o" if any(words[0] == b"o" for _, words in found) else b"g"
    runs: list[Run] = []
    name, count = "", 0
    for line, words in found:
        if words[0] in (b"f", b"fo"):
            count += len(words) - 3
        elif words[0] == opens:
            runs.append((name, count))
            name, count = _name(lines[line - 1]), 0
    return [*runs, (name, count)]


def _name(line: bytes) -> str:
    """Return what stands behind the keyword, which is one letter."""
    return _COMMENT.sub(b"", line.strip()[1:]).strip().decode("utf-8", "replace")
