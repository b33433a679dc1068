"""The lines of a section of bulk data, those without comments and blanks, as arrays.

A card is a line that begins with a name, and the lines behind it that continue it: those whose
first column is blank, `+`, `*` or, in free fields, a comma.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.mesh.formats.nastran.deck import Deck, SectionRange

#: Columns that count in fixed fields; what stands behind them is no data.
COLUMNS = 80
#: The first eight columns hold the name, or of a continuation its own name.
HEAD = 8
_BLANK, _TAB, _FEED, _COMMA, _STAR, _PLUS, _DOLLAR = (ord(letter) for letter in " \t\n,*+$")
_CONTINUING = (_BLANK, _TAB, _COMMA, _STAR, _PLUS)

#: How a line's fields are separated: fixed ones of 8 columns or 16, or by commas or tabs.
SMALL, LARGE, OTHER = range(3)


class Cards(NamedTuple):
    """Holds the cards of one name.

    Args:
        lines: rows of the lines that begin them, (n,).
        more: how many lines continue each, (n,).
    """

    lines: NDArray[np.int64]
    more: NDArray[np.int64]


class Lines:
    """Holds the lines of a section that say something.

    Args:
        deck: the deck, whose line numbers errors name.
        section: which lines of it.

    Attributes:
        text: the section's bytes, and blanks behind them.
        starts: byte at which each line begins.
        lengths: bytes that count: up to a comment or the line's end.
        numbers: the deck's number of each line, counted from 0.
        kinds: `SMALL`, `LARGE` or `OTHER` of each.
    """

    def __init__(self, deck: Deck, section: SectionRange) -> None:
        self._deck = deck
        self._data = deck.text[section.start : section.end] + b" " * (2 * COLUMNS)
        self.text = np.frombuffer(self._data, dtype=np.uint8)
        used = self.text[: section.end - section.start]
        ends = np.flatnonzero(used == _FEED)
        if len(used) and (not len(ends) or ends[-1] != len(used) - 1):
            ends = np.append(ends, len(used))
        starts = np.concatenate([np.zeros(min(1, len(ends)), dtype=np.int64), ends[:-1] + 1])
        stops = _cut_at_comments(used, starts, ends)
        says = _that_say_something(used, starts, stops)
        self.starts, self.lengths = starts[says], stops[says] - starts[says]
        self.numbers = np.flatnonzero(says) + section.line
        self.kinds = self._found_kinds(used)

    def __len__(self) -> int:
        return len(self.starts)

    def columns(self, lines: NDArray[np.int64], first: int, count: int) -> NDArray[np.uint8]:
        """Return columns of some lines, (n, count), blank behind a line's end; `first` from 0."""
        windows = sliding_window_view(self.text, count)
        letters: NDArray[np.uint8] = windows[self.starts[lines] + first]
        behind = np.arange(first, first + count) >= self.lengths[lines][:, np.newaxis]
        letters[behind] = _BLANK
        return letters

    def content(self, line: int) -> bytes:
        """Return all that counts of one line."""
        return self.contents(np.array([line]))[0]

    def contents(self, lines: NDArray[np.int64]) -> list[bytes]:
        """Return all that counts of some lines."""
        starts = self.starts[lines]
        stops = starts + self.lengths[lines]
        data = self._data
        return [
            data[start:stop] for start, stop in zip(starts.tolist(), stops.tolist(), strict=True)
        ]

    def cards(self) -> dict[bytes, Cards]:
        """Return the cards of each name.

        Raises:
            MeshError: the first line continues nothing.
        """
        if not len(self):
            return {}
        first = self.text[self.starts]
        begins = np.flatnonzero(~np.isin(first, _CONTINUING))
        if not len(begins) or begins[0]:
            raise self._deck.error(
                int(self.numbers[0]),
                "continues a card, but none stands before it",
                "the deck was cut: write it again",
            )
        more = np.diff(np.append(begins, len(self))) - 1
        head = self.columns(begins, 0, HEAD)
        parting = np.isin(head, (_BLANK, _TAB, _COMMA, _STAR))
        head[np.logical_or.accumulate(parting, axis=1)] = _BLANK
        keys = np.ascontiguousarray(head).view(np.uint64)[:, 0]
        # Most cards follow others of their name: names are told apart by runs of them.
        runs = np.flatnonzero(np.append(True, keys[1:] != keys[:-1]))
        found, which = np.unique(keys[runs], return_inverse=True)
        which = np.repeat(which.reshape(-1), np.diff(np.append(runs, len(keys))))
        # Few bits are sorted by counting, much faster than many.
        short = which.astype(np.int16) if len(found) < 1 << 15 else which
        order = np.argsort(short, kind="stable")
        parts = np.split(order, np.cumsum(np.bincount(which, minlength=len(found)))[:-1])
        names = [key.tobytes().strip() for key in found]
        by_name = {
            name: Cards(begins[part], more[part]) for name, part in zip(names, parts, strict=True)
        }
        # In the order in which names are met, so that the first line in fault is the one named.
        return dict(sorted(by_name.items(), key=lambda item: int(item[1].lines[0])))

    def _found_kinds(self, used: NDArray[np.uint8]) -> NDArray[np.int8]:
        """Return how each line's fields are separated."""
        head = self.columns(np.arange(len(self)), 0, HEAD)
        named = np.isin(head[:, 0], _CONTINUING, invert=True)
        large = np.where(named, (head == _STAR).any(axis=1), head[:, 0] == _STAR)
        kinds = np.where(large, LARGE, SMALL).astype(np.int8)
        marks = np.flatnonzero((used == _COMMA) | (used == _TAB))
        lines = np.searchsorted(self.starts, marks, side="right") - 1
        inside = (lines >= 0) & (marks < (self.starts + self.lengths)[lines])
        kinds[lines[inside]] = OTHER
        return kinds


def _cut_at_comments(
    text: NDArray[np.uint8], starts: NDArray[np.int64], ends: NDArray[np.int64]
) -> NDArray[np.int64]:
    """Return where each line's content stops: at its first dollar sign, or its end.

    Two programs take a line for a comment that begins with `#` or `//` as well, which no card does.
    """
    dollars = np.append(np.flatnonzero(text == _DOLLAR), len(text))
    stops: NDArray[np.int64] = np.minimum(dollars[np.searchsorted(dollars, starts)], ends)
    if len(text) > 1:
        letter = text[np.minimum(starts, len(text) - 1)]
        second = text[np.minimum(starts + 1, len(text) - 1)]
        other = (letter == ord("#")) | ((letter == ord("/")) & (second == ord("/")))
        stops[other] = starts[other]
    return stops


def _that_say_something(
    text: NDArray[np.uint8], starts: NDArray[np.int64], stops: NDArray[np.int64]
) -> NDArray[np.bool_]:
    """Return which lines hold more than blanks before they stop."""
    says = starts < stops
    lines = np.flatnonzero(says)
    first = text[starts[lines]]
    doubtful = lines[(first == _BLANK) | (first == _TAB)]
    says[_blank_ones(text, starts, stops, doubtful)] = False
    return says


def _blank_ones(
    text: NDArray[np.uint8],
    starts: NDArray[np.int64],
    stops: NDArray[np.int64],
    lines: NDArray[np.int64],
) -> NDArray[np.int64]:
    """Return those of some lines that hold blanks alone."""
    if not len(lines):
        return lines
    ink = (text != _BLANK) & (text != _TAB) & (text != _FEED)
    # Sums over [start, stop) and what lies between are taken by turns.
    bounds = np.stack([starts[lines], stops[lines]], axis=1).ravel()
    inside = np.logical_or.reduceat(np.append(ink, False), bounds)[::2]
    return lines[~inside]
