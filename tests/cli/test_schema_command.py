"""What scripts count on: schemas are schemas, old documents satisfy them, and damaged ones do not.

That documents of today do is tested wherever a command is (`tests/cli/conftest.py`).
"""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from claims.schemas import name_of, require_valid, require_valid_lines
from jsonschema import Draft202012Validator

from obbcli.cli.app import app
from obbcli.report.schema import NAMES, schema_of, schema_of_all

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

GOLDEN = Path(__file__).resolve().parents[1] / "data" / "documents"
# Documents that version 1 wrote, those of studies cut short; they are never made again.
FILES = sorted(path.name for path in GOLDEN.glob("*.json"))


def read(name: str) -> Any:
    """Return a document."""
    return json.loads((GOLDEN / name).read_text())


def places(value: Any, path: tuple[str | int, ...] = ()) -> Iterator[tuple[str | int, ...]]:
    """Yield the way to everything inside a document; of lists that of the first item alone."""
    items: list[tuple[str | int, Any]] = []
    if isinstance(value, dict):
        items = list(value.items())
    elif isinstance(value, list):
        items = list(enumerate(value[:1]))
    for key, part in items:
        yield (*path, key)
        yield from places(part, (*path, key))


def with_parent(document: Any, path: tuple[str | int, ...]) -> tuple[Any, Any]:
    """Return a copy of a document, and what holds the last key of a path in it."""
    changed = copy.deepcopy(document)
    parent = changed
    for key in path[:-1]:
        parent = parent[key]
    return changed, parent


@pytest.mark.parametrize("name", NAMES)
def test_schemas_are_schemas(name: str) -> None:
    Draft202012Validator.check_schema(schema_of(name))


def test_every_document_has_a_golden_one() -> None:
    rows = {"sweep", "sweep-row"}  # in the results of a sweep
    assert {name_of(read(file)) for file in FILES} == set(NAMES) - rows
    assert (GOLDEN / "sweep.jsonl").exists()


@pytest.mark.parametrize("file", FILES)
def test_golden_documents_satisfy_their_schemas(file: str) -> None:
    document = read(file)
    require_valid(document)
    Draft202012Validator(schema_of(name_of(document))).validate(document)
    Draft202012Validator(schema_of_all()).validate(document)


def test_golden_results_of_a_sweep_satisfy_their_schemas() -> None:
    text = (GOLDEN / "sweep.jsonl").read_text()
    require_valid_lines(text)
    every = Draft202012Validator(schema_of_all())
    for line in text.splitlines():
        every.validate(json.loads(line))


@pytest.mark.parametrize("file", FILES)
def test_damaged_documents_are_refused(file: str) -> None:
    document = read(file)
    check = Draft202012Validator(schema_of(name_of(document)))
    missed: list[tuple[str, Any]] = []
    # Left free: keys that only some questions have, and what rows of a sweep leave out.
    free = {"witness", "pairs", "pairs_complete", "limits"}
    for path in places(document):
        changed, parent = with_parent(document, path)
        parent[path[-1]] = {"no": {"such": "thing"}}
        if check.is_valid(changed) and "options" not in path:
            missed.append(("replaced", path))
        if isinstance(path[-1], int):
            continue  # a list may be shorter
        del parent[path[-1]]
        key = str(path[-1])
        is_optional = key.startswith("contacts") or free.intersection(map(str, path))
        # There where a file was changed, or parts of it were selected.
        is_optional = is_optional or key in ("notes", "parts", "part_a", "part_b")
        is_optional = is_optional or key.startswith("released")  # with --after-release
        is_optional = is_optional or key == "image_tests"  # documents from before it lack it
        is_table = {"seconds", "options"}.intersection(map(str, path[:-1]))
        if check.is_valid(changed) and not (is_optional or is_table):
            missed.append(("removed", path))
    assert not missed


def test_new_keys_are_allowed() -> None:
    document = read("distance.json")
    document["result"]["of_a_later_version"] = 1
    Draft202012Validator(schema_of("distance")).validate(document)


def test_one_document_does_not_pass_as_another() -> None:
    document = read("distance.json") | {"schema": "obbtree/collide/1"}
    assert not Draft202012Validator(schema_of_all()).is_valid(document)


def test_every_command_that_has_documents_has_a_schema() -> None:
    assert set(app.commands or app.list_commands(None)) - {"schema", "manual"} <= set(NAMES)  # type: ignore[arg-type]


def test_units_are_told() -> None:
    described = schema_of("first-contact")["properties"]["result"]["properties"]
    assert described["time"]["description"].startswith("s;")
    assert described["distance"]["description"].startswith("mesh units;")
    assert all("description" in field for field in described.values())
    assert "None" not in json.dumps(schema_of_all())


@pytest.mark.parametrize("name", NAMES)
def test_the_command_prints_schemas(obbtree: Callable[..., Any], name: str) -> None:
    assert obbtree("schema", name).json == schema_of(name)
    assert obbtree("schema", name, "--json").out.count("\n") == 1


def test_the_command_prints_one_of_all(obbtree: Callable[..., Any], here: Path) -> None:
    assert obbtree("schema").json == schema_of_all()
    assert obbtree("schema", "-o", "all.json").out == ""
    assert json.loads((here / "all.json").read_text()) == schema_of_all()


def test_unknown_names_are_usage(obbtree: Callable[..., Any]) -> None:
    ended = obbtree("schema", "collisions")
    assert (ended.code, ended.out) == (2, "")
    assert "'collide'" in ended.err
