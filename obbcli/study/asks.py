"""Which questions studies ask."""

from __future__ import annotations

from typing import Literal, TypeAlias, get_args

RestAsk: TypeAlias = Literal["distance", "overlap"]
"""Of bodies at t = 0."""
Ask: TypeAlias = Literal["first-contact", "distance", "overlap"]
ASKS: tuple[Ask, ...] = get_args(Ask)
