"""Documents held against their schemas, strictly: what a schema does not name may not be there."""

from __future__ import annotations

import json
from functools import cache
from typing import Any

from jsonschema import Draft202012Validator

from obbcli.report.schema import schema_of


def name_of(document: dict[str, Any]) -> str:
    """Return which schema a document says it follows."""
    tool, name, version = document["schema"].split("/")
    assert (tool, version) == ("obbtree", "1")
    return str(name)


def require_valid(document: Any, name: str | None = None) -> None:
    """Fail where a document is not as its schema says, or has a key that it does not name."""
    faults = list(_strict(name or name_of(document)).iter_errors(document))
    assert not faults, [(fault.json_path, fault.message) for fault in faults]


def require_valid_lines(text: str) -> None:
    """Fail where the results of a sweep, header and rows, are not as their schemas say."""
    header, *rows = [json.loads(line) for line in text.splitlines()]
    require_valid(header, "sweep")
    for row in rows:
        require_valid(row, "sweep-row")


@cache
def _strict(name: str) -> Draft202012Validator:
    schema = schema_of(name)
    Draft202012Validator.check_schema(schema)
    return Draft202012Validator(closed(schema))


def closed(schema: Any) -> Any:
    """Return a schema that forbids what it does not name."""
    if isinstance(schema, list):
        return [closed(part) for part in schema]
    if not isinstance(schema, dict):
        return schema
    parts = {key: closed(part) for key, part in schema.items()}
    if "properties" in schema and schema.get("type") in ("object", ["object", "null"]):
        parts["additionalProperties"] = False
    return parts
