"""The files that a Nastran deck is made of: the one opened, and those that INCLUDE names."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from obbcli.mesh.formats.text import shown, strip_mark
from obbcli.mesh.source import Source, read_source

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.errors import MeshError

#: INCLUDE within INCLUDE, deeper than any project goes.
_DEEPEST = 20
#: A file's text may stand in a deck several times, as materials of superelements do. What all take
#: is bounded by a multiple of what the files hold, so that no few lines fill the memory.
_TIMES = 16
_LEAST = 1 << 26
#: So many letters of a name are shown.
_SHOWN = 100
#: Lines that one name of a file may take.
_NAME_LINES = 64


class Included(NamedTuple):
    """Holds lines of one file that follow one another in the deck.

    Args:
        source: the file, which errors name.
        line: the number of the first line in it, counted from 1.
        text: the lines in capitals, each ended by a line feed.
    """

    source: Source
    line: int
    text: bytes


def included_files(source: Source) -> list[Included]:
    """Return a deck's lines in order, those of included files in place of their statements.

    Nothing follows ENDDATA. A file that is named lies at or below the folder of the deck; it is
    looked for beside the file that names it, then beside the deck.

    Raises:
        MeshError: a file that is missing or elsewhere, one that includes itself, names that do not
            end, ENDDATA in an included file with more lines behind its INCLUDE.
    """
    reading = _Reading(source)
    parts = list(reading.parts(source, ()))
    return parts or [Included(source, 1, b"\n")]


def statements(text: bytes, word: bytes) -> list[tuple[int, int]]:
    """Return where the lines begin whose first word is `word`, and where the word ends.

    Args:
        text: lines in capitals.
        word: in capitals; blanks may stand before it.
    """
    found = []
    at = text.find(word)
    while at >= 0:
        behind = at + len(word)
        begin = text.rfind(b"\n", 0, at) + 1
        if not text[begin:at].strip() and not text[behind : behind + 1].isalnum():
            found.append((begin, behind))
        at = text.find(word, behind)
    return found


class _Reading:
    """Follows the INCLUDE statements of a deck."""

    def __init__(self, deck: Source) -> None:
        self._deck = deck
        self._read: dict[Path, Source] = {}
        self._held = len(deck.data)
        self._used = 0
        self._ended: MeshError | None = None

    def parts(self, source: Source, above: tuple[Path, ...]) -> Iterator[Included]:
        """Yield the lines of a file; `above` are the files that include it, outermost first."""
        text = _lines_of(source)
        capitals = text.upper()
        self._count(source, len(text))
        start, line = 0, 1
        ends = statements(capitals, b"ENDDATA")
        for begin, behind in sorted(ends + statements(capitals, b"INCLUDE")):
            if begin < start:
                continue  # within the name of a file
            yield from self._taken(source, line, capitals[start:begin])
            line += text.count(b"\n", start, begin)
            if (begin, behind) in ends:
                if above:
                    fault = (
                        "ENDDATA in an included file, but lines follow in the file that names it"
                    )
                    self._ended = source.error(fault, "take ENDDATA out of it", at=str(line))
                return
            name, start = _name_after(source, text, behind, line)
            yield from self._followed(source, name, line, above)
            line += text.count(b"\n", begin, start)
        yield from self._taken(source, line, capitals[start:])

    def _taken(self, source: Source, line: int, text: bytes) -> Iterator[Included]:
        if self._ended and re.search(rb"^[ \t]*[^\s$]", text, re.MULTILINE):
            raise self._ended
        if text:
            yield Included(source, line, text)

    def _followed(
        self, source: Source, name: str, line: int, above: tuple[Path, ...]
    ) -> Iterator[Included]:
        file = self._found(source, name, line)
        opened = (*above, _real_path(source))
        if _real_path(file) in opened:
            raise source.error(
                f"INCLUDE '{_shown(name)}' includes itself", "take it out", at=str(line)
            )
        if len(opened) > _DEEPEST:
            raise source.error(f"INCLUDE goes deeper than {_DEEPEST} files", at=str(line))
        yield from self.parts(file, opened)

    def _found(self, source: Source, name: str, line: int) -> Source:
        """Return the file that a statement names."""
        if self._deck.path is None or source.path is None:
            fault = f"INCLUDE '{_shown(name)}' names a file, and a stream lies in no folder"
            raise source.error(fault, "name the deck's file instead of a stream", at=str(line))
        plain = name.replace("\\", "/")
        if plain.startswith("/") or ":" in plain or ".." in plain.split("/"):
            raise source.error(
                f"INCLUDE '{_shown(name)}' is not a path at or below the deck's folder",
                "copy the file there, and name it from there",
                at=str(line),
            )
        root = self._deck.path.parent
        for folder in dict.fromkeys((source.path.parent, root)):
            path = folder / plain
            if _is_file(path):
                return self._source_of(source, path, line)
        raise source.error(
            f"INCLUDE '{_shown(name)}': there is no such file beside it",
            f"copy the file to {root}, its name as it is written here",
            at=str(line),
        )

    def _source_of(self, source: Source, path: Path, line: int) -> Source:
        real = path.resolve()
        if not real.is_relative_to(_real_path(self._deck).parent):
            fault = f"INCLUDE '{_shown(path.name)}' leads out of the deck's folder"
            raise source.error(fault, "copy the file there", at=str(line))
        if real not in self._read:
            self._read[real] = read_source(path)
            self._held += len(self._read[real].data)
        return self._read[real]

    def _count(self, source: Source, length: int) -> None:
        self._used += length
        if self._used > _TIMES * self._held + _LEAST:
            raise source.error("INCLUDE repeats files until they fill the memory", "name each once")


def _name_after(source: Source, text: bytes, start: int, line: int) -> tuple[str, int]:
    """Return the name behind the word INCLUDE, and where the line after it begins.

    A name in quotes may go on over several lines, whose blanks at both ends do not count.
    """
    end = _line_end(text, start)
    rest = text[start:end].strip(b" \t,=")
    quote = rest[:1]
    if quote not in (b"'", b'"'):
        name = rest.partition(b"$")[0].strip()
    else:
        name, rest = b"", rest[1:]
        for _ in range(_NAME_LINES):
            part, closed, _ = rest.partition(quote)
            name += part.strip()
            if closed:
                break
            begin, end = end + 1, _line_end(text, end + 1)
            rest = text[begin:end].strip()
        else:
            raise source.error("INCLUDE's name has no closing quote", "add it", at=str(line))
    if not name:
        raise source.error("INCLUDE names no file", "name one, or take it out", at=str(line))
    try:
        return name.decode("utf-8"), min(end + 1, len(text))
    except UnicodeDecodeError as fault:
        words = f"INCLUDE's name '{shown(name)}' is not UTF-8"
        raise source.error(words, "give the file a plain name", at=str(line)) from fault


def _shown(name: str) -> str:
    """Return a file's name as errors show it: of a long one, the beginning."""
    return name if len(name) <= _SHOWN else f"{name[:_SHOWN]}..."


def _is_file(path: Path) -> bool:
    """Return whether a file is there; a name that no system takes is none."""
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def _real_path(source: Source) -> Path:
    """Return where a file lies, links followed; of a stream, nowhere that a file could lie."""
    return Path("/dev/null/stream") if source.path is None else source.path.resolve()


def _line_end(text: bytes, start: int) -> int:
    end = text.find(b"\n", start)
    return len(text) if end < 0 else end


def _lines_of(source: Source) -> bytes:
    """Return a file's text with line feeds alone between lines, and one at its end.

    Files of Windows may be UTF-16, which its mark tells, or end with Control-Z.
    """
    data = source.data
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        data = data.decode("utf-16", errors="replace").encode("utf-8")
    data = strip_mark(data).rstrip(b"\x1a")
    if b"\0" in data:
        line = data.count(b"\n", 0, data.index(b"\0")) + 1
        fault = "holds a NUL byte, which no text does"
        raise source.error(fault, "export it again as a text deck", at=str(line))
    if b"\r" in data:
        data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    return data if data.endswith(b"\n") else data + b"\n"
