"""Names that are looked up: what to say where one is not known."""

from __future__ import annotations

from typing import TYPE_CHECKING

from obbcli.errors import SceneError

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

# More would hide what they are listed for.
_MOST_LISTED = 12


def known_keys(found: Iterable[object], known: Sequence[str], where: str) -> None:
    """Refuse keys that are not known.

    Raises:
        SceneError: the first of them, and the known key that is nearest to it.
    """
    for key in found:
        if key not in known:
            raise SceneError(where, f"unknown key {key!r}", nearest(str(key), known))


def nearest(word: str, known: Sequence[str]) -> str:
    """Return the remedy for a name that is not known: the nearest one that is, or all of them."""
    hint = meant(word, known)
    if hint or not known:
        return hint or "there is none at all"
    more = f" and {len(known) - _MOST_LISTED} more" if len(known) > _MOST_LISTED else ""
    return "known are " + ", ".join(known[:_MOST_LISTED]) + more


def meant(word: str, known: Iterable[str]) -> str:
    """Return the question whether the nearest known name was meant; empty where none is near."""
    from difflib import get_close_matches

    near = get_close_matches(word, list(known), n=1)
    return f"did you mean {near[0]!r}?" if near else ""
