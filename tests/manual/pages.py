"""The README and the topics of the manual as text: blocks, sections, tables, links."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from obbcli.manual import FOLDER

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).resolve().parents[2]
TOOLS = ROOT / "tests" / "tools"
README = ROOT / "README.md"
PAGES = {
    path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8")
    for path in (README, *sorted(FOLDER.glob("*.md")))
}


class Block(NamedTuple):
    """A fenced block, with the page and the heading it stands under."""

    page: str
    heading: str
    language: str
    text: str

    @property
    def name(self) -> str:
        """Return what a test of it is called."""
        return f"{Path(self.page).stem}: {self.heading}"


def blocks(language: str) -> list[Block]:
    """Return all fenced blocks in a language."""
    pattern = re.compile(r"^#+ ([^\n]+)$|^```(\w*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
    found = []
    for page, text in PAGES.items():
        heading = ""
        for match in pattern.finditer(text):
            heading = match[1] or heading
            if match[1] is None and match[2] == language:
                found.append(Block(page, heading, match[2], match[3]))
    return found


def topic(name: str) -> str:
    """Return a topic's text."""
    return PAGES[f"obbcli/manual/{name}.md"]


def without_code(text: str) -> str:
    """Return a page without its fenced blocks; their lines are left empty."""
    return re.sub(
        r"^```.*?^```$", lambda m: "\n" * m[0].count("\n"), text, flags=re.DOTALL | re.MULTILINE
    )


def headings(text: str) -> list[str]:
    """Return the headings of a page."""
    return re.findall(r"^#+ (.+)$", without_code(text), re.MULTILINE)


def anchor(heading: str) -> str:
    """Return the anchor that a forge gives a heading."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def section(text: str, heading: str) -> str:
    """Return what stands under a heading, up to the next one of its rank or above."""
    match = re.search(rf"^(#+) {re.escape(heading)}$", text, re.MULTILINE)
    assert match is not None, f"no heading {heading!r}"
    rest = text[match.end() :]
    end = re.search(rf"^#{{1,{len(match[1])}}} ", without_code(rest), re.MULTILINE)
    if end is None:
        return rest
    lines = without_code(rest)[: end.start()].count("\n")
    return "\n".join(rest.split("\n")[:lines])


def tables(text: str) -> Iterator[list[list[str]]]:
    """Yield the tables of a text, each as rows of cells, the heading first."""
    for lines in re.findall(r"(?:^\|.*\|\n?)+", without_code(text), re.MULTILINE):
        cells = [
            [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
            for line in lines.splitlines()
        ]
        yield [cells[0], *cells[2:]]


def table_rows(text: str) -> list[list[str]]:
    """Return the cells of all tables of a text, but not those of their first rows."""
    return [row for table in tables(text) for row in table[1:]]


def links(text: str) -> list[str]:
    """Return where the links and pictures of a page lead."""
    return re.findall(r"\]\(([^)\s]+)\)", without_code(text))


def is_explained(word: str, text: str) -> bool:
    """Return whether a word or option stands in code in a text, outside of examples."""
    prose = re.sub(r"^```(console|python).*?^```$", "", text, flags=re.DOTALL | re.M)
    code = re.findall(r"^```.*?^```$|`[^`\n]+`", prose, re.DOTALL | re.MULTILINE)
    whole = re.compile(rf"(?<![\w-]){re.escape(word)}(?![\w-])")
    return any(whole.search(span) for span in code)
