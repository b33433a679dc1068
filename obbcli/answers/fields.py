"""What the fields of an answer hold, as their annotations say: columns and schemas follow these."""

from __future__ import annotations

from types import NoneType
from typing import Any, Literal, NamedTuple, get_args, get_origin, get_type_hints


class Field(NamedTuple):
    """A field of a dataclass.

    Attributes:
        name: its name.
        type: what it holds where it applies.
        is_optional: whether it is None elsewhere.
    """

    name: str
    type: Any
    is_optional: bool

    @property
    def words(self) -> tuple[str, ...]:
        """Return the words that it is one of; empty where it holds something else."""
        return get_args(self.type) if get_origin(self.type) is Literal else ()


def fields_of(cls: type) -> list[Field]:
    """Return the fields of a dataclass, in its order."""
    return [Field(name, *without_none(hint)) for name, hint in get_type_hints(cls).items()]


def without_none(hint: Any) -> tuple[Any, bool]:
    """Return a type without None, and whether None was a part of it."""
    parts = get_args(hint)
    if NoneType not in parts:
        return hint, False
    (rest,) = (part for part in parts if part is not NoneType)
    return rest, True
