"""Words of text as whole numbers, many at a time: what `int` makes of each, or none at all."""

from __future__ import annotations

import itertools

import pytest

from obbcli.mesh.formats.text import all_whole

WORDS = [
    *(b"0", b"1", b"007", b"-1", b"+3", b"4611686018427387903", b"4611686018427387904"),
    *(b"9223372036854775807", b"9223372036854775808", b"-9223372036854775809", b"9" * 30),
    *(b"1.5", b"x", b"1-2", b"--1", b"0x1", b"\xd9\xa1", b"1e3", b"nan", b"1,2"),
]


def one_by_one(words):
    """Return what `int` makes of words; None where it takes one for none, or 64 bits do not."""
    try:
        values = [int(word) for word in words]
    except ValueError:
        return None
    return values if all(-(2**63) <= value < 2**63 for value in values) else None


@pytest.mark.parametrize("count", [0, 1, 2, 3])
def test_words_are_taken_together_as_they_are_one_by_one(count):
    for words in itertools.product(WORDS, repeat=count):
        found = all_whole(list(words))
        assert (None if found is None else found.tolist()) == one_by_one(words), words
