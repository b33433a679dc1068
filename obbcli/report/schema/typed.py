"""Schemas of the fields of a dataclass, as their annotations and its docstring say."""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING, Any, Literal, get_args, get_origin

from obbcli.answers.contact import Vector
from obbcli.answers.fields import fields_of, without_none
from obbcli.report.schema.words import (
    AMOUNT,
    COUNT,
    FLAG,
    TEXT,
    VECTOR,
    documented,
    or_null,
    tuple_of,
    word_of,
)

if TYPE_CHECKING:
    from obbcli.report.schema.words import Schema

# Lengths, times and counters are never below 0: what may be is to be said by its own schema.
_KINDS: dict[object, Schema] = {
    float: AMOUNT,
    int: COUNT,
    bool: FLAG,
    str: TEXT,
    Vector: VECTOR,
}


def schemas_of(cls: type, **own: Schema) -> dict[str, Schema]:
    """Return the schema of each field of a dataclass, described as its docstring does.

    Args:
        cls: the class; its annotations can be looked up when it runs.
        own: of fields whose type does not say all.
    """
    fields = {
        field.name: _or_null(own.get(field.name) or schema_of(field.type), field.is_optional)
        for field in fields_of(cls)
    }
    return documented(cls, fields)


def schema_of(kind: Any) -> Schema:
    """Return the schema of what has a type: a number, a word, a vector, a tuple of such."""
    kind, is_optional = without_none(kind)
    if kind in _KINDS:
        schema = _KINDS[kind]
    elif get_origin(kind) is Literal:
        schema = word_of(get_args(kind))
    elif get_origin(kind) is tuple:
        schema = tuple_of(*map(schema_of, get_args(kind)))
    else:
        assert issubclass(kind, Enum), kind
        schema = word_of(one.value for one in kind)
    return _or_null(schema, is_optional)


def _or_null(schema: Schema, is_optional: bool) -> Schema:
    return or_null(schema) if is_optional else schema
