"""The text of a Nastran deck: INCLUDE followed, ENDDATA obeyed, sections of bulk data found.

Line by line nothing is interpreted here. Comments begin with `$` in any column; statements are
compared in capitals, names of files as they are written.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

from obbcli.mesh.formats.nastran.include import Included, included_files, statements
from obbcli.mesh.formats.text import shown

if TYPE_CHECKING:
    from obbcli.errors import MeshError
    from obbcli.mesh.source import Source

#: The name of the section that is no superelement's.
MAIN = "BULK"
#: Columns of a statement; serial numbers may stand behind them.
_STATEMENT = 72


class SectionRange(NamedTuple):
    """Holds where a section of bulk data stands; its GRIDs and elements are numbered apart.

    Args:
        name: `BULK`, or `SUPER=n` of a superelement that the deck holds as a part.
        start: byte of the deck's text where it begins.
        end: byte behind its last.
        line: the line at `start`, counted from 0 over the whole deck.
    """

    name: str
    start: int
    end: int
    line: int


class Deck:
    """Holds a deck's lines in capitals, included files in their places, up to ENDDATA.

    Args:
        source: the file that was opened.

    Raises:
        MeshError: an included file that is not there or not below the deck's folder, statements
            that place other models beside this one, or no bulk data.
    """

    def __init__(self, source: Source) -> None:
        self._source = source
        files = included_files(source)
        self._files: list[Included] = files
        self._firsts = []
        line = 0
        for file in files:
            self._firsts.append(line)
            line += file.text.count(b"\n")
        self.text = b"".join(file.text for file in files)
        self.sections = self._found_sections()

    def error(self, line: int, fault: str, remedy: str = "") -> MeshError:
        """Return an error at a line of the deck, counted from 0; it names the file it stands in."""
        number = bisect_right(self._firsts, line) - 1
        file = self._files[number]
        return file.source.error(fault, remedy, at=str(file.line + line - self._firsts[number]))

    def place(self, line: int) -> str:
        """Return a line as errors name it beside another one."""
        return self.error(line, "").where.rpartition("/")[2]

    def note(self, text: str) -> None:
        """Tell what is taken with a change."""
        self._source.note(text)

    def _found_sections(self) -> list[SectionRange]:
        """Return the sections of bulk data; without BEGIN BULK all of the deck is one."""
        begins = [begin for begin, _ in statements(self.text, b"BEGIN") if self._is_section(begin)]
        first = begins[0] if begins else len(self.text)
        restart = statements(self.text[:first], b"RESTART")
        if begins and restart:
            raise self._at(
                restart[0][0],
                "RESTART takes the rest of the model from another run's database",
                "export the whole model as one deck",
            )
        if not begins:
            control = statements(self.text, b"CEND")
            if control:
                raise self._at(
                    control[0][0],
                    "CEND ends the executive control, but no BEGIN BULK follows",
                    "it was cut short: write it again",
                )
            return [SectionRange(MAIN, 0, len(self.text), 0)]
        sections: dict[str, SectionRange] = {}
        for start, end in pairwise([*begins, len(self.text)]):
            name = self._name_of(start)
            if name in sections:
                raise self._at(start, f"'BEGIN {name}' stands here a second time", "keep one")
            after = self._after_line(start)
            line = self.text.count(b"\n", 0, after)
            sections[name] = SectionRange(name, after, max(end, after), line)
        return list(sections.values())

    def _after_line(self, start: int) -> int:
        end = self.text.find(b"\n", start)
        return len(self.text) if end < 0 else end + 1

    def _statement(self, start: int) -> list[bytes]:
        """Return the words of the statement in the line that begins at a byte."""
        line = self.text[start : self._after_line(start)].partition(b"$")[0][:_STATEMENT]
        return re.split(rb"[\s=,]+", line.strip())

    def _is_section(self, start: int) -> bool:
        """Return whether BEGIN opens more than the section of a beam, which has no surface."""
        return not b"".join(self._statement(start)[1:2]).startswith(b"HYPRBEAM")

    def _name_of(self, start: int) -> str:
        """Return the name of the section that a BEGIN statement opens."""
        statement = self._statement(start)
        words = statement[1:]
        if words == [b"BULK"]:
            return MAIN
        if words[:1] == [b"BULK"]:
            words = words[1:]
        if words[:1] == [b"SUPER"] and len(words) <= 2:
            return "=".join(word.decode("latin-1") for word in words)
        raise self._at(
            start,
            f"'{shown(b' '.join(statement))}' begins something else than bulk data "
            "of the structure or of a superelement",
            "take the section out of the deck if it is no part of the model",
        )

    def _at(self, byte: int, fault: str, remedy: str) -> MeshError:
        return self.error(self.text.count(b"\n", 0, byte), fault, remedy)
