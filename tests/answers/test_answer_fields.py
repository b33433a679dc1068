"""What fields hold, read from annotations: columns and schemas of contacts follow it."""

from __future__ import annotations

import dataclasses
import itertools

from obbcli.answers.contact import Contact, Vector
from obbcli.answers.fields import fields_of
from obbcli.sweeps.answer_rows import RAW, ROW


def test_fields_come_in_the_order_of_the_class():
    names = [field.name for field in dataclasses.fields(Contact)]

    assert [field.name for field in fields_of(Contact)] == names


def test_fields_tell_what_they_hold_and_whether_they_may_be_none():
    fields = {field.name: field for field in fields_of(Contact)}

    assert fields["point"][1:] == (Vector, True)
    assert fields["error_bound"][1:] == (float, False)
    assert fields["triangle_a"][1:] == (int, True)
    assert fields["contained"].words == ("a", "b")
    assert fields["distance"].words == ()
    assert fields["time_bounds"].type == tuple[float, float | None]


def test_sweeps_have_a_column_for_each_field_that_is_asked_for():
    names = {field.name for field in fields_of(Contact)}

    assert names - set(ROW.names) == {"time_bounds"}
    assert {"time_lo", "time_hi"} <= set(ROW.names)


def test_columns_of_the_kernels_lie_apart_within_a_row():
    taken = sorted((offset, offset + kind.itemsize) for kind, offset in RAW.fields.values())

    assert all(end <= start for (_, end), (start, _) in itertools.pairwise(taken))
    assert taken[-1][1] <= RAW.itemsize
