"""Fields of Nastran's cards: small ones of 8 columns, large ones of 16, free ones between commas.

Cards in fixed fields, which are nearly all, are cut out many at a time; those with commas or tabs,
and those whose lines differ, one by one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from obbcli.mesh.formats.nastran.lines import COLUMNS, HEAD, LARGE, SMALL
from obbcli.mesh.formats.text import shown

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.mesh.formats.nastran.deck import Deck
    from obbcli.mesh.formats.nastran.lines import Cards, Lines

#: Fields of a line, and columns of each.
_SHAPES = {SMALL: (8, 8), LARGE: (4, 16)}


def field_table(deck: Deck, lines: Lines, cards: Cards, count: int) -> NDArray[np.bytes_]:
    """Return the first `count` fields behind the name of each card, (n, count), blank where none.

    Raises:
        MeshError: a line with more items than a card's line has, or one that lacks its second half.
    """
    kinds = [_common_kind(lines, cards, kind, count) for kind in (SMALL, LARGE)]
    parts = [
        (chosen, _fixed(lines, _some(cards, chosen), kind, count))
        for kind, chosen in zip((SMALL, LARGE), kinds, strict=True)
        if chosen.any()
    ]
    rest = ~(kinds[0] | kinds[1])
    if rest.any():
        parts.append((rest, _one_by_one(deck, lines, _some(cards, rest), count)))
    width = max([1, *(part.dtype.itemsize for _, part in parts)])
    table = np.zeros((len(cards.lines), count), dtype=f"S{width}")
    for chosen_rows, part in parts:
        table[chosen_rows] = part
    return table


def _some(cards: Cards, chosen: NDArray[np.bool_]) -> Cards:
    return type(cards)(cards.lines[chosen], cards.more[chosen])


def _common_kind(lines: Lines, cards: Cards, kind: int, count: int) -> NDArray[np.bool_]:
    """Return which cards have this kind in all lines that `count` fields can take."""
    most = -(-count // _SHAPES[kind][0])
    same = np.ones(len(cards.lines), dtype=bool)
    for step in range(most):
        there = cards.more >= step
        same[there] &= lines.kinds[cards.lines[there] + step] == kind
    return same


def _fixed(lines: Lines, cards: Cards, kind: int, count: int) -> NDArray[np.bytes_]:
    """Return fields of cards whose lines are all of one fixed kind."""
    per_line, width = _SHAPES[kind]
    table = np.zeros((len(cards.lines), count), dtype=f"S{width}")
    for first in range(0, count, per_line):
        there = cards.more >= first // per_line
        wanted = min(per_line, count - first)
        rows = cards.lines[there] + first // per_line
        letters = np.ascontiguousarray(lines.columns(rows, HEAD, wanted * width))
        table[there, first : first + wanted] = letters.view(f"S{width}").reshape(-1, wanted)
    return table


def _one_by_one(deck: Deck, lines: Lines, cards: Cards, count: int) -> NDArray[np.bytes_]:
    """Return fields of cards whose lines may be of any kind."""
    # No card needs more lines than there are half lines of large fields.
    used = np.minimum(cards.more, -(-count // 4)) + 1
    firsts = np.cumsum(used) - used
    rows = np.repeat(cards.lines - firsts, used) + np.arange(int(used.sum()))
    texts = lines.contents(rows)
    table = []
    for line, first, length in zip(
        cards.lines.tolist(), firsts.tolist(), used.tolist(), strict=True
    ):
        card = texts[first : first + length]
        table.append(_split_card(deck, lines.numbers[line : line + length], card, count))
    return np.array(table, dtype=np.bytes_).reshape(-1, count)


def _split_card(
    deck: Deck, numbers: NDArray[np.int64], texts: list[bytes], count: int
) -> list[bytes]:
    """Return the fields of one card, whose lines have these numbers in the deck."""
    fields: list[bytes] = []
    halves = 0
    for row, text in enumerate(texts):
        if len(fields) >= count and halves % 2 == 0:
            break
        free = b"," in text
        found, is_large = _free(text) if free else _separated(text)
        if free:
            _check_ends(deck, int(numbers[row]), text, found, 4 if is_large else 8)
        if halves % 2 and not is_large:
            raise deck.error(
                int(numbers[row]),
                "continues a line of large fields in small ones",
                "begin it with *",
            )
        halves = halves + 1 if is_large else 0
        per_line = 4 if is_large else 8
        fields += found[:per_line] + [b""] * (per_line - len(found))
    return (fields + [b""] * count)[:count]


def _separated(text: bytes) -> tuple[list[bytes], bool]:
    """Return a line's fields in columns, and whether they are large."""
    # A tab goes on to the next multiple of eight columns.
    text = text.expandtabs(HEAD)[:COLUMNS]
    is_large = text[:1] == b"*" or (text[:1] not in (b" ", b"+") and b"*" in text[:HEAD])
    per_line, width = _SHAPES[LARGE if is_large else SMALL]
    starts = range(HEAD, HEAD + per_line * width, width)
    return [text[start : start + width] for start in starts], is_large


def _free(text: bytes) -> tuple[list[bytes], bool]:
    """Return all that stands between commas behind the first, and whether fields are large."""
    items = text.split(b",")
    return items[1:], b"*" in items[0]


def _check_ends(deck: Deck, number: int, text: bytes, items: list[bytes], per_line: int) -> None:
    """Refuse data before the first comma, and behind the last field.

    There a line has its name, and the name of the line that continues it.
    """
    name = text[: text.index(b",")]
    if len(name.split()) > 1 or _is_number(name.strip()):
        fault = f"has '{shown(name.strip())}' before its first comma, expected one name or none"
        raise deck.error(number, fault, "separate all fields by commas, or none")
    if len(items) > per_line:
        behind = [item.strip() for item in items[per_line:]]
        if any(behind[1:]) or _is_number(behind[0]):
            fault = f"has '{shown(b','.join(behind))}' behind its {per_line} fields"
            raise deck.error(number, fault, "put it on a line of its own that begins with + or *")


def _is_number(word: bytes) -> bool:
    """Return whether a name of a continuation would be data; `+1` is a name."""
    return word[:1].isdigit() or word[:1] in (b"-", b".")
