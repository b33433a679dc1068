"""Records of ASCII Tecplot files: what the words before the numbers of a zone say.

The grammar is that of "ASCII Data", Tecplot 360 Data Format Guide; the older words F=FEPOINT, ET=
and D= are read as well.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

from obbcli.mesh.formats.text import shown

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.mesh.source import Source

_RECORD = re.compile(
    rb"^[ \t]*(TITLE|VARIABLES|FILETYPE|ZONE|TEXT|GEOMETRY|CUSTOMLABELS|DATASETAUXDATA|VARAUXDATA)"
    rb"(?![A-Za-z0-9_])",
    re.MULTILINE | re.IGNORECASE,
)
#: Lines that may hold a comment: after # outside of quotes.
_COMMENT = re.compile(rb"^[^\n]*#[^\n]*", re.MULTILINE)
_PAIR = re.compile(
    rb"[\s,]*(?:AUXDATA\s+)?([A-Za-z_][\w.]*)\s*=\s*"
    rb"(\"(?:[^\"\\]|\\.)*\"|'[^'\n]*'|\((?:[^()]|\([^()]*\))*\)|\[[^\]]*\]|[^\s,]+)",
    re.IGNORECASE | re.DOTALL,
)
_AUXILIARY = re.compile(rb"[\s,]*AUXDATA\s", re.IGNORECASE)
_NUMBER = re.compile(rb"[\s,]*([-+.\d]|nan\b|inf)", re.IGNORECASE)
_NAME = re.compile(rb"\"([^\"]*)\"|([^\s,\"=]+)")
_CHOICE = re.compile(r"\s*,?\s*\[([^\]]*)\](?:\s*=\s*(\w+))?")
#: Keys that say nothing of the mesh.
_PASSED_OVER = """C DT PARENTZONE FACENEIGHBORMODE NUMCONNECTEDBOUNDARYFACES NV FACES
TOTALNUMBOUNDARYCONNECTIONS TOTALNUMFACENODES"""
_READ = """T I J K N E NODES ELEMENTS ET F D ZONETYPE DATAPACKING VARLOCATION VARSHARELIST
CONNECTIVITYSHAREZONE PASSIVEVARLIST FACENEIGHBORCONNECTIONS STRANDID SOLUTIONTIME"""
_KNOWN = frozenset(_PASSED_OVER.split() + _READ.split())


class Record(NamedTuple):
    """Holds where a record stands in the text, from its first word to the next record."""

    kind: str
    start: int
    end: int
    line: int


@dataclass
class Zone:
    """Holds a zone's header.

    Args:
        keys: its values as they are written, by key in capitals.
        line: where it begins.
        data: its numbers, as text.
        first: the line of the first of them.
        cell_centred: variables, from 0, with a value a cell.
        shared: variables with the zone, from 0, that they are taken from.
        passive: variables without values.
    """

    keys: dict[str, str]
    line: int
    data: bytes
    first: int
    cell_centred: set[int] = field(default_factory=set)
    shared: dict[int, int] = field(default_factory=dict)
    passive: set[int] = field(default_factory=set)

    @property
    def name(self) -> str:
        """Return its title."""
        return self.keys.get("T", "").strip("\"'")


def clean_text(data: bytes) -> bytes:
    """Return a file's text with one kind of line end and without comments."""
    if b"\r" in data:
        data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    return _COMMENT.sub(_without_comment, data) if b"#" in data else data


def _without_comment(match: re.Match[bytes]) -> bytes:
    pieces = match[0].split(b'"')
    for at in range(0, len(pieces), 2):
        bare, mark, _ = pieces[at].partition(b"#")
        if mark:
            return b'"'.join([*pieces[:at], bare])
    return match[0]


def records(text: bytes) -> Iterator[Record]:
    """Yield the records of a file in order."""
    found = list(_RECORD.finditer(text))
    line, seen = 1, 0
    ends = [*(match.start() for match in found[1:]), len(text)]
    for match, end in zip(found, ends, strict=False):
        line += text.count(b"\n", seen, match.start())
        seen = match.start()
        yield Record(match[1].decode().upper(), match.end(), end, line)


def variables(text: bytes, record: Record) -> list[str]:
    """Return the names of VARIABLES, quoted or not."""
    names = _NAME.findall(text[record.start : record.end])
    return [(quoted or bare).decode("latin-1").strip() for quoted, bare in names]


def read_zone(source: Source, text: bytes, record: Record, number: int, width: int) -> Zone:
    """Return the header of a zone, and the text of its numbers.

    Args:
        source: the file, which errors name.
        text: of the whole file.
        record: the zone's.
        number: of zones before it.
        width: how many variables there are.

    Raises:
        MeshError: a key that is not known, a list that is none; with the line.
    """
    keys, at = {}, record.start
    while match := _PAIR.match(text, at, record.end):
        if not _AUXILIARY.match(text, at, record.end):
            keys[match[1].decode("latin-1").upper()] = match[2].decode("latin-1")
        at = match.end()
    line = record.line + text.count(b"\n", record.start, at)
    if _NUMBER.match(text, at, record.end) is None:
        rest = text[at : record.end].strip(b" \t\n,")
        if rest:
            fault = f"'{shown(rest.split()[0])}' in the words of a zone"
            raise source.error(fault, "write KEY = VALUE, then the numbers", at=str(line))
    unknown = next((key for key in keys if key not in _KNOWN), None)
    if unknown is not None:
        fault = f"the key {unknown[:40]} of a zone is not known"
        raise source.error(fault, "remove it if it says nothing of the mesh", at=str(record.line))
    zone = Zone(keys, record.line, text[at : record.end], line)
    _set_lists(source, zone, number, width)
    return zone


def _set_lists(source: Source, zone: Zone, number: int, width: int) -> None:
    """Set which variables are at cells, shared and passive."""
    every = [f"[{at + 1}]={word}" for at, word in enumerate(_words(zone, "VARLOCATION"))]
    location = zone.keys.get("VARLOCATION", "")
    text = location if "[" in location else f"({','.join(every)})"
    for at, word in _choices(source, zone, "VARLOCATION", text, width):
        if word.upper() not in ("CELLCENTERED", "NODAL"):
            raise _no_list(source, zone, "VARLOCATION")
        if word.upper() == "CELLCENTERED":
            zone.cell_centred.add(at)
    for at, word in _choices(source, zone, "VARSHARELIST", zone.keys.get("VARSHARELIST"), width):
        zone.shared[at] = _zone_before(source, zone, word, number)
    for word in _words(zone, "D"):
        if word.upper() == "FECONNECT":
            zone.keys["CONNECTIVITYSHAREZONE"] = str(number)
        else:
            at = next(_range(source, zone, "D", word, width))
            zone.shared[at] = _zone_before(source, zone, "", number)
    passive = zone.keys.get("PASSIVEVARLIST", "")
    text = passive if passive.startswith("(") else f"({passive})"
    zone.passive |= {at for at, _ in _choices(source, zone, "PASSIVEVARLIST", text, width)}


def _words(zone: Zone, key: str) -> list[str]:
    text = zone.keys.get(key, "").strip("()")
    return text.replace(",", " ").split() if "[" not in text else []


def _choices(
    source: Source, zone: Zone, key: str, text: str | None, width: int
) -> Iterator[tuple[int, str]]:
    """Yield variable and value of a list such as ([1-3,5]=2,[7])."""
    if text is None:
        return
    inner, at = text.strip()[1:-1].rstrip(), 0
    seen: set[int] = set()
    while at < len(inner):
        match = _CHOICE.match(inner, at)
        if match is None:
            raise _no_list(source, zone, key)
        for variable in _range(source, zone, key, match[1], width):
            if variable in seen:
                raise _no_list(source, zone, key)
            seen.add(variable)
            yield variable, match[2] or ""
        at = match.end()


def _range(source: Source, zone: Zone, key: str, text: str, width: int) -> Iterator[int]:
    """Yield variables, from 0, of a list such as 1-3,5."""
    for piece in text.split(","):
        first, _, last = piece.partition("-")
        bounds = [word.strip() for word in (first, last or first)]
        if not all(word.isdecimal() and len(word) < 7 for word in bounds):
            raise _no_list(source, zone, key)
        if not 1 <= int(bounds[0]) <= int(bounds[1]) <= width:
            raise _no_list(source, zone, key)
        yield from range(int(bounds[0]) - 1, int(bounds[1]))


def _zone_before(source: Source, zone: Zone, word: str, number: int) -> int:
    """Return a zone, from 0, that stands before this one; without a number the one before."""
    wanted = int(word) if word.isdecimal() and len(word) < 10 else 0 if word else number
    if not 1 <= wanted <= number:
        fault = f"a zone shares what zone '{word[:20]}' has, which does not stand before it"
        raise source.error(fault, "export the file again", at=str(zone.line))
    return wanted - 1


def _no_list(source: Source, zone: Zone, key: str) -> Exception:
    fault = f"{key}={zone.keys.get(key, '')[:60]} is no list of variables"
    return source.error(fault, "write it as ([1-3,5]=VALUE)", at=str(zone.line))
