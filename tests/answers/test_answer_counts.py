"""Counters of searches: what they add up to, and that every answer tells them."""

from __future__ import annotations

import obbcli
from obbcli.answers.counts import Counts, QueryStats


def test_counts_add_up_field_by_field():
    assert Counts(1, 20, 300, 4000, 5) + Counts(5, 60, 700, 8000, 9) == (6, 80, 1000, 12000, 14)


def test_difference_of_counts_is_what_was_spent_between():
    assert Counts(6, 80, 1000, 12000, 14) - Counts(5, 60, 700, 8000, 9) == (1, 20, 300, 4000, 5)


def test_counts_begin_at_nothing():
    assert Counts() == (0, 0, 0, 0, 0)


def test_stats_begin_with_the_counts_of_the_search():
    assert QueryStats._fields[:5] == Counts._fields
    stats = obbcli.collide("sample_meshes/gear.stl", "sample_meshes/gear.stl").stats

    assert stats.counts == stats[:5]
    assert stats.counts.box_tests > 0
