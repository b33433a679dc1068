"""The words that JSON Schemas are written in: numbers, vectors, records of named fields."""

from __future__ import annotations

import inspect
import re
from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

Schema: TypeAlias = "dict[str, Any]"

NUMBER: Schema = {"type": "number"}
# Lengths, times, counters: never below 0.
AMOUNT: Schema = {"type": "number", "minimum": 0}
COUNT: Schema = {"type": "integer", "minimum": 0}
FLAG: Schema = {"type": "boolean"}
TEXT: Schema = {"type": "string"}
SHA256: Schema = {"type": "string", "pattern": "^[0-9a-f]{64}$"}
VECTOR: Schema = {"type": "array", "items": NUMBER, "minItems": 3, "maxItems": 3}

_SECTION = re.compile(r"^Attributes:\n(.*?)(?:\n\S|\Z)", re.MULTILINE | re.DOTALL)
_ENTRY = re.compile(r"^    (\w+): (.*?)(?=^    \w+: |\Z)", re.MULTILINE | re.DOTALL)


def ref(name: str) -> Schema:
    """Return a reference to a shared definition."""
    return {"$ref": f"#/$defs/{name}"}


def word_of(words: Iterable[str]) -> Schema:
    """Return one of some words."""
    return {"enum": list(words)}


def list_of(items: Schema, length: int | None = None) -> Schema:
    """Return an array, of a fixed length where one is given."""
    limits = {} if length is None else {"minItems": length, "maxItems": length}
    return {"type": "array", "items": items} | limits


def tuple_of(*items: Schema) -> Schema:
    """Return an array of so many items, each of its own kind."""
    return {"type": "array", "prefixItems": list(items), "items": False, "minItems": len(items)}


def or_null(schema: Schema) -> Schema:
    """Return what may also be null: a field that does not apply."""
    if isinstance(schema.get("type"), str):
        return schema | {"type": [schema["type"], "null"]}
    if "enum" in schema:
        return schema | {"enum": [*schema["enum"], None]}
    return {"anyOf": [schema, {"type": "null"}]}


def told(schema: Schema, description: str) -> Schema:
    """Return a schema that says what it is, and in which unit."""
    return schema | {"description": description}


def record(
    fields: Mapping[str, Schema], *, optional: Iterable[str] = (), description: str = ""
) -> Schema:
    """Return an object. Its keys are all there but for the optional ones; later versions may add.

    Args:
        fields: its values by their keys.
        optional: keys that are there only where they were asked for.
        description: what it is.
    """
    left_out = set(optional)
    schema: Schema = {
        "type": "object",
        "properties": dict(fields),
        "required": [name for name in fields if name not in left_out],
    }
    return told(schema, description) if description else schema


def table_of(values: Schema, description: str) -> Schema:
    """Return an object whose keys are not fixed."""
    return {"type": "object", "additionalProperties": values, "description": description}


def documented(cls: type, fields: Mapping[str, Schema]) -> dict[str, Schema]:
    """Return fields with the descriptions that a class gives its attributes.

    So that each is said once; those that have one already keep it. Python run with -OO has no
    docstrings, and descriptions are left out.
    """
    texts = _attribute_texts(cls)
    return {
        name: told(schema, texts[name]) | schema if name in texts else schema
        for name, schema in fields.items()
    }


def _attribute_texts(cls: type) -> dict[str, str]:
    """Return what the docstring of a class and those above it say of each attribute."""
    texts: dict[str, str] = {}
    for one in reversed(cls.__mro__):
        section = _SECTION.search(inspect.cleandoc(one.__doc__ or ""))
        if section is not None:
            entries = _ENTRY.findall(section[1] + "\n")
            texts |= {name: _plain(text) for name, text in entries}
    return texts


def _plain(text: str) -> str:
    """Return a text as documents have it: on one line, without marks of code, null for None."""
    return " ".join(re.sub(r"\bNone\b", "null", text.replace("`", "")).split())
