"""README and manual are short, lead somewhere, and say where their figures come from."""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path

from manual.pages import (
    PAGES,
    README,
    ROOT,
    anchor,
    headings,
    links,
    section,
    table_rows,
    tables,
    without_code,
)

from obbcli.manual import FOLDER, TOPICS, summary

MOST_LINES = {"README.md": 220}
MOST_LINES_OF_A_TOPIC = 300
MOST_BYTES_OF_README = 10_000
LONGEST_LINE = 200
LONGEST_SUMMARY = 66
# In cells of tables: what is measured carries such a unit.
MEASURED = re.compile(r"\d (ns|us|ms|s)\b|\d (MiB|KiB|GB)\b")
FIGURE = re.compile(r"\**[\d.]")


def sections(text: str) -> list[tuple[str, str]]:
    """Return every heading of a page with what stands between it and the next one."""
    found = list(re.finditer(r"^#+ (.+)$", without_code(text), re.MULTILINE))
    ends = [match.start() for match in found[1:]] + [len(text)]
    plain = without_code(text)
    return [(match[1], plain[match.end() : end]) for match, end in zip(found, ends, strict=True)]


def is_of_measurements(table: list[list[str]]) -> bool:
    """Return whether a table holds figures: some with units, or two columns of numbers."""
    rows = table[1:]
    cells = [cell for row in rows for cell in row]
    columns = list(zip(*rows, strict=True))
    numbers = [sum(bool(FIGURE.match(cell)) for cell in column) for column in columns]
    many = [count for count in numbers if 2 * count > len(rows)]
    return sum(bool(MEASURED.search(cell)) for cell in cells) >= 3 or len(many) >= 2


def test_pages_are_short() -> None:
    lines = {page: text.count("\n") for page, text in PAGES.items()}
    long = {
        page: count
        for page, count in lines.items()
        if count > MOST_LINES.get(page, MOST_LINES_OF_A_TOPIC)
    }

    assert long == {}
    assert README.stat().st_size <= MOST_BYTES_OF_README


def test_lines_are_short() -> None:
    long = [
        f"{page}:{number}"
        for page, text in PAGES.items()
        for number, line in enumerate(without_code(text).split("\n"), 1)
        if len(line) > LONGEST_LINE
    ]

    assert long == []


def test_topics_are_one_list() -> None:
    rows = table_rows(section(PAGES["README.md"], "The manual"))
    shown = [re.fullmatch(r"\[([\w-]+)\]\(obbcli/manual/\1\.md\)", row[0]) for row in rows]

    assert [match and match[1] for match in shown] == list(TOPICS)
    assert {path.stem for path in FOLDER.glob("*.md")} == set(TOPICS)
    assert len(set(TOPICS)) == len(TOPICS)


def test_topics_say_in_a_short_sentence_what_they_are_about() -> None:
    rows = table_rows(section(PAGES["README.md"], "The manual"))

    assert [row[1].replace("`", "") for row in rows] == [summary(name) for name in TOPICS]
    assert [name for name in TOPICS if not 0 < len(summary(name)) <= LONGEST_SUMMARY] == []
    assert [name for name in TOPICS if not summary(name).endswith(".")] == []


def test_history_stands_last() -> None:
    assert TOPICS[-2:] == ("decisions", "changes")
    dated = re.findall(r"^- (\d{4}-\d{2}-\d{2}): ", PAGES["obbcli/manual/decisions.md"], re.M)
    entries = re.findall(r"^- ", PAGES["obbcli/manual/decisions.md"], re.M)
    assert len(dated) == len(entries) > 0
    assert all(newer >= older for newer, older in pairwise(dated))


def test_links_lead_somewhere() -> None:
    broken = []
    for page, text in PAGES.items():
        for link in links(text):
            name, _, place = link.partition("#")
            if link.startswith("https://"):
                continue
            target = (ROOT / page).parent / name if name else ROOT / page
            known = PAGES.get(target.resolve().relative_to(ROOT).as_posix(), "")
            if not target.exists() or (place and place not in map(anchor, headings(known))):
                broken.append(f"{page}: {link}")

    assert broken == []


def test_anchors_are_unique() -> None:
    twice = [
        f"{page}: {heading}"
        for page, text in PAGES.items()
        for heading in headings(text)
        if [anchor(one) for one in headings(text)].count(anchor(heading)) > 1
    ]

    assert twice == []


def test_tables_have_rows_of_one_length() -> None:
    ragged = [
        f"{page}: {row}"
        for page, text in PAGES.items()
        for table in tables(text)
        for row in table
        if len(row) != len(table[0])
    ]

    assert ragged == []


def test_tables_of_measurements_name_date_and_machine() -> None:
    silent = [
        f"{page}: {heading}"
        for page, text in PAGES.items()
        for heading, body in sections(text)
        if any(map(is_of_measurements, tables(body)))
        and not (re.search(r"\b\d{4}-\d{2}-\d{2}\b", body) and re.search(r"\bcores?\b", body))
    ]

    assert silent == []


def test_what_measurements_look_like_is_seen() -> None:
    assert is_of_measurements([["", "a"], ["x", "1 ms"], ["y", "2 ms, 3 us"], ["z", "4 s"]])
    assert is_of_measurements([["", "times", "ends"], ["x", "500", "0"], ["y", "9", "**1**"]])
    assert not is_of_measurements([["code", "meaning"], ["0", "answered"], ["1", "contact"]])


def known_packages() -> set[str]:
    """Return the packages that the project names as its own needs."""
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    return set(re.findall(r'"([A-Za-z][\w-]*)>=', text)) | {"atheris"}


def works(words: list[str]) -> bool:
    """Return whether `pip install` of these can work, though obbtree is on no index."""
    known = known_packages()
    # Texts that name one package or another have its name in braces.
    works = known | {".", "git+URL", "{name}", "{package}"}
    return bool(words) and all(word in works or word.endswith(".whl") for word in words)


def test_pip_install_lines_name_what_can_be_installed() -> None:
    texts = {"README.md": PAGES["README.md"]}
    for folder in ("obbcli", "sample_meshes", "tests"):
        for path in (ROOT / folder).rglob("*"):
            if path.suffix in {".md", ".py", ".toml", ".yml"} and path != Path(__file__):
                texts[path.relative_to(ROOT).as_posix()] = path.read_text(encoding="utf-8")
    wrong = []
    for name, text in texts.items():
        for asked in re.findall(r"pip install ([^`\n,;)\"]*)", text):
            if not works(re.sub(r"'|\\n|\$", "", asked).split()):
                wrong.append(f"{name}: pip install {asked}")
        # An extra of a project that is on no index.
        wrong += [f"{name}: {extra}" for extra in re.findall(r"obbtree\[\w*\]", text)]

    assert wrong == []
