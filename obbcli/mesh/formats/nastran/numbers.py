"""Numbers of Nastran's fields, whole arrays at a time.

A real number may leave out the letter of its exponent (`1.5-3` is 0.0015) or have D for it. Every
number becomes the double nearest to what is written.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

_BLANK, _PLUS, _MINUS, _NINE, _ZERO = (ord(letter) for letter in " +-90")
#: More digits than any identification number has would not fit into an int64.
_DIGITS = 18


def whole_numbers(fields: NDArray[np.bytes_]) -> NDArray[np.int64]:
    """Return identification numbers, of the fields' shape: 0 where blank, -1 where it is none.

    A number is digits alone, with blanks and one plus sign before them, blanks behind them.
    """
    letters = _letters(fields)
    result = np.zeros(len(letters), dtype=np.int64)
    filled = np.flatnonzero((letters != _BLANK).any(axis=1))
    letters = letters[filled]
    values = np.zeros(len(letters), dtype=np.int64)
    before = np.zeros(len(letters), dtype=bool)
    runs, digits, other = (np.zeros(len(letters), dtype=np.uint8) for _ in range(3))
    for column in np.ascontiguousarray(letters.T):
        digit = column - np.uint8(_ZERO)  # above 9 for all other letters
        is_digit = digit <= _NINE - _ZERO
        values = np.where(is_digit, values * 10 + digit, values)
        runs += is_digit & ~before
        digits += is_digit
        # One plus sign may stand right before the digits.
        other += ~is_digit & (column != _BLANK) & ((column != _PLUS) | (runs > 0))
        before = is_digit
    signs = (letters == _PLUS).sum(axis=1)
    apart = (letters[:, :-1] == _PLUS) & (letters[:, 1:] == _BLANK)
    wrong = (runs != 1) | (other > 0) | (digits > _DIGITS) | (signs > 1) | apart.any(axis=1)
    result[filled] = np.where(wrong, -1, values)
    return result.reshape(fields.shape)


def real_numbers(fields: NDArray[np.bytes_]) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Return real numbers of the fields' shape, 0 where blank, and which fields are none.

    A number without a decimal point is taken, as several programs write; one that is not finite in
    double is none.
    """
    letters = _letters(fields)
    letters[(letters == _BLANK).all(axis=1), 0] = _ZERO
    letters[letters == ord("D")] = ord("E")
    digit = (letters >= _ZERO) & (letters <= _NINE)
    sign = (letters == _PLUS) | (letters == _MINUS)
    point = letters == ord(".")
    known = digit | sign | point | (letters == _BLANK) | (letters == ord("E"))
    letters = _with_exponents(letters, sign[:, 1:] & (digit | point)[:, :-1])
    words = np.ascontiguousarray(letters).view(f"S{letters.shape[1]}")[:, 0]
    words[~known.all(axis=1)] = b"?"
    try:
        values = words.astype(np.float64)
    except ValueError:
        values = np.array([_real(word) for word in words.tolist()], dtype=np.float64)
    wrong = ~np.isfinite(values)
    return values.reshape(fields.shape), wrong.reshape(fields.shape)


def _with_exponents(letters: NDArray[np.uint8], bare: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """Return the letters with an E before each exponent that has none.

    Args:
        letters: (n, width).
        bare: (n, width - 1), whether the letter behind is the sign of such an exponent.
    """
    rows = bare.any(axis=1)
    if not rows.any():
        return letters
    count, width = letters.shape
    wide = np.full((count, width + 1), _BLANK, dtype=np.uint8)
    wide[:, :width] = letters
    columns = np.arange(width + 1)
    sign = bare[rows].argmax(axis=1)[:, np.newaxis] + 1
    moved = np.take_along_axis(wide[rows], columns - (columns > sign), axis=1)
    moved[columns == sign] = ord("E")
    wide[rows] = moved
    return wide


def _letters(fields: NDArray[np.bytes_]) -> NDArray[np.uint8]:
    """Return the fields' bytes, a row a field, in memory of their own."""
    width = fields.dtype.itemsize
    letters: NDArray[np.uint8] = np.ascontiguousarray(fields).view(np.uint8)
    letters = letters.reshape(-1, width).copy()
    letters[letters == 0] = _BLANK  # the end of a shorter field
    return letters


def _real(word: bytes) -> float:
    """Return the number that a field spells, NaN where it spells none."""
    try:
        return float(word)
    except ValueError:
        return math.nan
