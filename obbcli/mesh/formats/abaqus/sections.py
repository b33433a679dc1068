"""An Abaqus or CalculiX deck as keywords, each with its parameters and its lines of data.

The syntax is that of "Input syntax rules" in the Abaqus Analysis User's Guide: a keyword line
begins with one asterisk, a comment with two and may stand anywhere, and *INCLUDE stands for the
lines of another file.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

from obbcli.mesh.formats.text import shown, strip_mark, whole
from obbcli.mesh.source import Source

if TYPE_CHECKING:
    from collections.abc import Iterator

_KEYWORD = re.compile(rb"^[ \t]*\*(?!\*)[^\n]*", re.MULTILINE)
_COMMENT = re.compile(rb"^[ \t]*\*\*[^\n]*", re.MULTILINE)
#: A line that can only go on with the parameters of a keyword: data begin with numbers or commas.
_PARAMETERS = re.compile(rb"[ \t]*[A-Za-z][A-Za-z \t]*(=[^\n]*)?(,[^\n]*)?$")
#: How many files a deck may name, one within the other and in all: some name each other.
_DEEPEST = 50
_MOST_FILES = 1000


#: The largest number of a node or element that Abaqus takes.
_LARGEST = 999_999_999


class Section(NamedTuple):
    """Holds a keyword and the data that follow it.

    Args:
        source: the file that it stands in.
        line: its number there.
        keyword: in capitals, without blanks and asterisk: `ENDPART`.
        options: its parameters by their names in capitals, as they are written; "" without a value.
        data: the lines after it, without comments.
        first: the number of the first of them.
    """

    source: Source
    line: int
    keyword: str
    options: dict[str, str]
    data: bytes
    first: int

    def label(self, option: str) -> str:
        """Return the name that an option gives, as names are compared: in capitals."""
        return self.options.get(option, "").upper()


class Deck:
    """Holds a deck and the files that it names, which lie at or below its folder.

    Args:
        source: the deck.

    Attributes:
        names: of the files that it names, as far as it has been read.
    """

    def __init__(self, source: Source) -> None:
        self._source = source
        self.names: dict[str, None] = {}
        self._open: list[str] = []
        self._files = 0

    def sections(self, source: Source | None = None) -> Iterator[Section]:
        """Yield the keywords in order, those of included files in the place of *INCLUDE.

        Raises:
            MeshError: a file that cannot be had; words before the first keyword; with the line.
        """
        source = source or self._source
        for section in _split(source):
            if section.keyword == "INCLUDE":
                yield from self._included(section)
            else:
                yield section

    def _included(self, section: Section) -> Iterator[Section]:
        name = section.options.get("INPUT", "")
        check_options(section, {"INPUT"})
        found = self.file(section, name)
        self._open.append(name)
        yield from self.sections(found)
        self._open.pop()

    def input_of(self, section: Section) -> Section:
        """Return a section with its data, which INPUT may say to lie in another file.

        Raises:
            MeshError: the file cannot be had, or holds keywords.
        """
        if "INPUT" not in section.options:
            return section
        found = self.file(section, section.options["INPUT"])
        data = _text(found)
        keyword = _KEYWORD.search(data)
        if keyword is not None:
            line = str(data.count(b"\n", 0, keyword.start()) + 1)
            fault = f"a keyword in a file of the data of *{section.keyword}"
            raise found.error(fault, "move it into the deck", at=line)
        if section.data.strip():
            fault = f"*{section.keyword} has data here and in '{section.options['INPUT']}'"
            raise section.source.error(fault, "keep one of the two", at=str(section.line))
        return section._replace(source=found, data=_COMMENT.sub(b"", data), first=1)

    def file(self, section: Section, name: str) -> Source:
        """Return a file that a keyword names.

        Raises:
            MeshError: it is not at or below the deck's folder, cannot be read, or includes itself.
        """
        source, line = section.source, str(section.line)
        self._files += 1
        place = f"*{section.keyword} names '{name}'"
        if not name:
            raise source.error(f"*{section.keyword} names no file", "add INPUT=FILE", at=line)
        if self._source.path is None:
            raise source.error(place, "name the deck's file instead of a stream", at=line)
        words = name.replace("\\", "/").split("/")
        if ":" in name or not words[0] or ".." in words:
            remedy = "move it at or below the deck's folder and name it from there"
            raise source.error(f"{place}, which is not below the deck's folder", remedy, at=line)
        if name in self._open or len(self._open) > _DEEPEST or self._files > _MOST_FILES:
            fault = f"{place}, which includes itself, or too many files"
            raise source.error(fault, "put the mesh into one file", at=line)
        folder = self._source.path.parent
        path = folder.joinpath(*words)
        # A link may lead out of the folder.
        if not (path.is_file() and path.resolve().is_relative_to(folder.resolve())):
            raise source.error(f"{place}, which is no file", "put it beside the deck", at=line)
        try:
            found = Source(str(path), path.name, path.read_bytes(), path)
        except OSError as fault:
            raise source.error(f"{place}: {fault.strerror}", at=line) from fault
        self.names[name] = None
        return found


def whole_word(section: Section, word: bytes, line: int, what: str) -> int:
    """Return a number or an increment of one, as *NGEN and the like use them.

    Raises:
        MeshError: it is not whole, or beyond what numbers of nodes and elements can be.
    """
    value = whole(section.source, word, line, what)
    return checked_number(section, value, line)


def checked_number(section: Section, value: int, line: int) -> int:
    """Return a number that nodes and elements can have.

    Raises:
        MeshError: it is too large.
    """
    if abs(value) > _LARGEST:
        fault = f"*{section.keyword}: {value} is no number of a node or element"
        raise section.source.error(fault, f"they go up to {_LARGEST}", at=str(line))
    return value


def check_options(section: Section, known: set[str]) -> None:
    """Refuse a parameter that is not understood, where it could place or make nodes and elements.

    Abbreviated parameters are written out: they need only be long enough to be told apart.

    Raises:
        MeshError: with the line.
    """
    write_out(section, known)
    for option in section.options:
        if option not in known:
            fault = f"*{section.keyword} with the parameter {option[:40]} is not read"
            remedy = "write the nodes and elements out, each with its number"
            raise section.source.error(fault, remedy, at=str(section.line))


def write_out(section: Section, known: set[str]) -> None:
    """Write parameters out that are abbreviated: GEN becomes GENERATE."""
    for option in [each for each in section.options if each not in known and len(each) > 2]:
        meant = [name for name in known if name.startswith(option)]
        if len(meant) == 1:
            section.options.setdefault(meant[0], section.options.pop(option))


def _text(source: Source) -> bytes:
    """Return a file with one kind of line end."""
    data = strip_mark(source.data)
    return data.replace(b"\r\n", b"\n").replace(b"\r", b"\n") if b"\r" in data else data


def _split(source: Source) -> Iterator[Section]:
    """Yield a file's keywords in order."""
    data = _text(source)
    found = _KEYWORD.finditer(data)
    match = next(found, None)
    head = _COMMENT.sub(b"", data[: match.start()] if match else data)
    if head.strip():
        line = head[: len(head) - len(head.lstrip())].count(b"\n") + 1
        fault = f"'{shown(head.split()[0])}' before the first keyword"
        remedy = "an Abaqus deck begins with a keyword such as *HEADING or *NODE"
        raise source.error(fault, remedy, at=str(line))
    line, seen = 1, 0
    while match is not None:
        after = next(found, None)
        end = after.start() if after else len(data)
        line += data.count(b"\n", seen, match.start())
        seen = match.start()
        words, start = _continued(data, match, end)
        keyword, options = _parsed(words)
        lines = data[start:end]
        if b"**" in lines:
            lines = _COMMENT.sub(b"", lines)
        first = line + data.count(b"\n", match.start(), start)
        yield Section(source, line, keyword, options, lines, first)
        match = after


def _continued(data: bytes, match: re.Match[bytes], end: int) -> tuple[str, int]:
    """Return a keyword line, joined with those it goes on in, and where its data begin."""
    words, start = [match[0].strip()], min(match.end() + 1, end)
    while words[-1].endswith(b",") and start < end:
        stop = data.find(b"\n", start, end)
        stop = end if stop < 0 else stop
        line = data[start:stop]
        if not _COMMENT.match(line):
            if not _PARAMETERS.match(line):
                break
            words.append(line.strip())
        start = min(stop + 1, end)
    return b"".join(words).decode("latin-1"), start


def _parsed(words: str) -> tuple[str, dict[str, str]]:
    """Return keyword and parameters of a keyword line; commas in quotes part nothing."""
    pieces = words.split('"')
    pieces[1::2] = [piece.replace(",", "\0") for piece in pieces[1::2]]
    keyword, *rest = "".join(pieces).split(",")
    options = {}
    for option in rest:
        name, _, value = option.partition("=")
        if name.strip():
            options["".join(name.upper().split())] = value.replace("\0", ",").strip()
    return "".join(keyword.upper().split()).lstrip("*"), options
