"""JSON Schemas (draft 2020-12) of every document: what scripts may count on.

Keys named here keep their meaning as long as the number at the end of `schema` stays. New ones may
come, so that nothing here forbids others.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from obbcli.report.record import SCHEMA_VERSION
from obbcli.report.schema.words import ref

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.report.schema.words import Schema

_DIALECT = "https://json-schema.org/draft/2020-12/schema"

# Name: where it is written, and which module here tells it. Imported when asked for: help is not.
_DOCUMENTS = {
    "build": ("obbtree build --json", "files"),
    "clearance": ("obbtree clearance --json", "clearances"),
    "collide": ("obbtree collide --json", "answers"),
    "distance": ("obbtree distance --json", "answers"),
    "error": ("standard error of a command with --json that fails", "files"),
    "first-contact": ("obbtree first-contact --json", "answers"),
    "info": ("obbtree info --json", "files"),
    "intervals": ("obbtree intervals --json", "intervals"),
    "overlap": ("obbtree overlap --json", "overlaps"),
    "range": ("obbtree range --json", "ranges"),
    "scene": ("obbtree scene --json", "answers"),
    "scene-clearances": ("obbtree scene --least-clearance --json", "clearances"),
    "scene-overlaps": ("obbtree scene --overlaps --json", "overlaps"),
    "stability": ("obbtree stability --json", "studies"),
    "sweep": ("the first line of the results of obbtree sweep", "files"),
    "sweep-row": ("every other line of the results of obbtree sweep", "files"),
    "sweep-summary": ("obbtree sweep --json", "files"),
    "tradeoff": ("obbtree tradeoff --json", "studies"),
    "view": ("obbtree view --json", "pictures"),
}
NAMES = tuple(_DOCUMENTS)


def schema_of(name: str) -> Schema:
    """Return the schema of one kind of document, with all that it refers to."""
    body = _body(name)
    return _head(name, _DOCUMENTS[name][0]) | body | {"$defs": _definitions(body)}


def schema_of_all() -> Schema:
    """Return a schema that all documents satisfy, and nothing else."""
    bodies = {f"document-{name}": {"title": _DOCUMENTS[name][0]} | _body(name) for name in NAMES}
    kinds = {"oneOf": [ref(name) for name in bodies]}
    return (
        _head("any", "any document of obbtree") | kinds | {"$defs": bodies | _definitions(bodies)}
    )


def _body(name: str) -> Schema:
    module = import_module(f"obbcli.report.schema.{_DOCUMENTS[name][1]}")
    schema: Schema = getattr(module, name.replace("-", "_"))()
    return schema


def _head(name: str, title: str) -> Schema:
    # No place on the network: schemas are looked up here and nowhere else.
    identity = f"urn:obbtree:schema:{name}:{SCHEMA_VERSION}"
    return {"$schema": _DIALECT, "$id": identity, "title": title}


def _definitions(schema: Schema) -> dict[str, Schema]:
    """Return the shared parts that a schema refers to, directly or through others."""
    from obbcli.report.schema.shared import DEFINITIONS

    wanted: set[str] = set()
    new = set(_references(schema))
    while new:
        wanted |= new
        new = {name for part in new for name in _references(DEFINITIONS[part])} - wanted
    return {name: part for name, part in DEFINITIONS.items() if name in wanted}


def _references(schema: object) -> Iterator[str]:
    """Yield the names of the shared parts that a schema refers to itself."""
    if isinstance(schema, dict):
        for key, value in schema.items():
            if key == "$ref":
                yield value.rpartition("/")[2]
            else:
                yield from _references(value)
    elif isinstance(schema, list):
        for value in schema:
            yield from _references(value)
