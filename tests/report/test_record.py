"""Records: the parts shared by all documents, and documents that parse everywhere."""

from __future__ import annotations

import hashlib
import io
import json
import math
import re

import numpy as np
import pytest

from obbcli import Body, Mesh, MeshError, Motion, ObbError, Pose, __version__
from obbcli.files import stamp_of
from obbcli.questions.pair_question import PairQuestion
from obbcli.report.document import to_json
from obbcli.report.record import document, error_document, file_sha256, finite, motion_part
from obbcli.report.table import Table, count, draw, length, seconds, size

SQUARE = Mesh([[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]], [[0, 1, 2], [0, 2, 3]])


def test_document_names_its_schema_and_tool_first():
    record = document("collide", {}, result={"status": "separated"})

    assert list(record) == ["schema", "tool_version", "inputs", "result"]
    assert record["schema"] == "obbtree/collide/1"
    assert record["tool_version"] == __version__


def part_of(a, b, duration=None):
    """Return what a record says of the motion of a question."""
    pair = PairQuestion.of(a, b, duration)
    return motion_part(pair.bodies, pair.duration)


def test_motion_reports_the_posed_centroid_as_pivot():
    body = Body(SQUARE, Pose((0, 0, math.pi / 2), (10, 0, 0)), Motion((1, 0, 0)))

    part = part_of(body, Body(SQUARE))

    np.testing.assert_allclose(part["a"]["pivot"], [9, 1, 0], atol=1e-15)
    assert part["b"]["pivot"] == [1.0, 1.0, 0.0]
    assert part["a"]["linear_velocity"] == [1.0, 0.0, 0.0]


def test_motion_reports_a_given_pivot_as_it_is():
    body = Body(SQUARE, Pose(translation=(10, 0, 0)), Motion(pivot=(5, 6, 7)))

    assert part_of(body, body)["a"]["pivot"] == [5.0, 6.0, 7.0]


def test_motion_reports_a_path_as_its_poses():
    poses = [Pose(translation=(0, 0, 1)), Pose((0, 0, math.pi / 2), (2, 0, 0))]
    body = Body(SQUARE, motion=Motion.through([0, 2.5], poses))

    part = part_of(body, Body(SQUARE))

    first, last = (
        {"rotation": pose.rotation.tolist(), "translation": pose.translation.tolist()}
        for pose in poses
    )
    assert part["a"] == {"pose": first, "times": [0.0, 2.5], "poses": [first, last]}
    assert part["duration"] == 2.5
    assert json.loads(to_json(part)) == part


@pytest.mark.parametrize(
    ("velocity", "duration", "used"),
    [((0, 0, 0), None, 0.0), ((0, 1, 0), None, 1.0), ((0, 1, 0), 3, 3.0), ((0, 0, 0), 3, 3.0)],
)
def test_duration_defaults_to_one_where_a_body_moves(velocity, duration, used):
    bodies = Body(SQUARE), Body(SQUARE, motion=Motion(velocity))

    assert part_of(*bodies, duration)["duration"] == used


def test_error_document_tells_place_fault_and_remedy_apart():
    part = error_document(MeshError("gear.obj:12", "uses vertex 9 of 8", "count from 1"), 3)

    assert part == {
        "schema": "obbtree/error/1",
        "tool_version": __version__,
        "error": "uses vertex 9 of 8",
        "kind": "MeshError",
        "code": 3,
        "where": "gear.obj:12",
        "remedy": "count from 1",
    }


@pytest.mark.parametrize("value", [5e-324, 0.1, 1 / 3, 1.7976931348623157e308, -0.0, 1e22])
def test_numbers_of_a_document_round_trip(value):
    text = to_json({"x": value})

    assert math.copysign(1, json.loads(text)["x"]) == math.copysign(1, value)
    assert json.loads(text)["x"] == value


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_document_never_holds_what_json_cannot(value):
    with pytest.raises(ValueError, match="not JSON compliant"):
        to_json({"x": value})
    assert finite(value) is None


def test_document_is_one_line_of_ascii_in_the_records_order():
    text = to_json({"z": "gér\udc80.stl", "a": [1, 2]})

    assert text == '{"z": "g\\u00e9r\\udc80.stl", "a": [1, 2]}\n'


def test_file_sha256_is_that_of_the_bytes(tmp_path):
    data = bytes(range(256)) * 9000
    (tmp_path / "data").write_bytes(data)

    assert file_sha256(tmp_path / "data") == hashlib.sha256(data).hexdigest()


def test_file_sha256_is_not_that_of_another_file_than_was_read(tmp_path):
    path = tmp_path / "data"
    path.write_bytes(b"one")
    read = stamp_of(path)
    assert file_sha256(path, read) == hashlib.sha256(b"one").hexdigest()
    (tmp_path / "other").write_bytes(b"two")
    (tmp_path / "other").replace(path)

    with pytest.raises(ObbError, match="changed while it was read"):
        file_sha256(path, read)


def drawn(*tables: Table) -> str:
    text = io.StringIO()
    draw(tables, text)
    return text.getvalue()


def test_table_without_headings_aligns_names_and_values():
    assert drawn(Table([("a", "1"), ("longer", "two words")])) == "a       1\nlonger  two words\n"


def test_table_with_headings_sets_numbers_flush_right():
    lines = drawn(Table([("x.stl", "5"), ("y.stl", "1,000")], ("mesh", "count"))).splitlines()

    assert lines[0].split() == ["mesh", "count"]
    assert set(lines[1]) == {"─"}
    assert [line.rindex(end) for line, end in zip(lines[2:], "50", strict=True)] == [
        len(lines[3]) - 1
    ] * 2


def test_table_shows_cells_as_they_are():
    cells = ":smile: [bold]x[/bold] [/]", "x" * 300

    assert drawn(Table([cells])) == "  ".join(cells) + "\n"


def test_tables_are_parted_by_an_empty_line_and_titled():
    assert drawn(Table([("a", "b")]), Table([("c", "d")], title="more")) == "a  b\n\nmore\nc  d\n"


class Terminal(io.StringIO):
    """A stream that says it is a terminal."""

    def isatty(self) -> bool:
        return True


def drawn_on_a_terminal(*tables: Table) -> str:
    terminal = Terminal()
    draw(tables, terminal)
    return terminal.getvalue()


@pytest.fixture
def colours(monkeypatch):
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.delenv("FORCE_COLOR", raising=False)
    monkeypatch.setenv("TERM", "xterm-256color")
    monkeypatch.setenv("COLUMNS", "60")


@pytest.mark.usefixtures("colours")
def test_table_is_plain_in_a_file_and_styled_on_a_terminal():
    table = Table([("a", "b")])

    assert "\x1b[" in drawn_on_a_terminal(table)
    assert "\x1b[" not in drawn(table)


@pytest.mark.usefixtures("colours")
@pytest.mark.parametrize(
    "table",
    [
        Table([("a", "1"), ("longer", "two words")]),
        Table([("x.stl", "5", ""), ("long name.stl", "1,000", "y")], ("mesh", "n", "flag")),
        Table([("1", "2")], ("triangle of A", "triangle of B"), "a title"),
        Table([("x.stl", "x.obbt", "5")], ("mesh file", "tree file", "count"), name_count=2),
    ],
)
def test_table_looks_alike_in_a_file_and_on_a_terminal(table):
    styled = drawn_on_a_terminal(table, table)

    plain = re.sub(r"\x1b\[[0-9;]*m", "", styled)
    assert "".join(line.rstrip() + "\n" for line in plain.splitlines()) == drawn(table, table)


@pytest.mark.usefixtures("colours")
def test_table_is_folded_on_a_terminal_alone():
    table = Table([("file", "x" * 100)])

    assert max(map(len, drawn(table).splitlines())) == 106
    assert "x" * 61 not in drawn_on_a_terminal(table)


@pytest.mark.usefixtures("colours")
def test_folding_on_a_terminal_cuts_no_number():
    numbers = ["1,996,002", "1,996,001", "289.6 MiB"]
    table = Table([("x" * 40, "y" * 40, *numbers)], ("a", "b", "c", "d", "e"), name_count=2)

    assert all(number in drawn_on_a_terminal(table) for number in numbers)


@pytest.mark.usefixtures("colours")
def test_long_list_is_plain_everywhere():
    table = Table([(str(i), str(i)) for i in range(1001)], ("A", "B"))

    assert drawn_on_a_terminal(table) == drawn(table)


def test_rule_is_ascii_where_the_encoding_is():
    raw = io.BytesIO()
    file = io.TextIOWrapper(raw, encoding="ascii")

    draw([Table([("1", "2")], ("A", "B"))], file)
    file.flush()

    assert raw.getvalue() == b"A   B\n-----\n1   2\n"


@pytest.mark.parametrize(
    ("shown", "wanted"),
    [
        (count(1234567), "1,234,567"),
        (length(0.123456789), "0.123457"),
        (length(None), "beyond the largest double"),
        (seconds(12.345), "12.35 s"),
        (seconds(0.0123), "12.30 ms"),
        (seconds(4.2e-5), "42 us"),
        (size(1023), "1023 B"),
        (size(1536), "1.5 KiB"),
        (size(5 << 20), "5.0 MiB"),
        (size(3 << 30), "3.0 GiB"),
    ],
)
def test_quantities_carry_their_units(shown, wanted):
    assert shown == wanted
