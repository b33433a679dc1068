"""Options of accuracy: one a field of `Accuracy`, with its default in the help."""

from __future__ import annotations

import pytest

from obbcli.accuracy import ASPECTS, Accuracy
from obbcli.cli.boundary import UsageError
from obbcli.cli.options.accuracy import AccuracyOptions


def options(**given: object) -> AccuracyOptions:
    """Return options of which some were given."""
    return AccuracyOptions(**{name: given.get(name) for name in AccuracyOptions._fields})


def test_every_field_has_an_option_of_its_name():
    assert {*AccuracyOptions._fields} == {*ASPECTS, "max_depth"}
    assert [*ASPECTS] == [*Accuracy().as_dict()]


def test_options_that_were_not_given_leave_what_was_asked_before():
    base = Accuracy(steps=7, method="sampled", clearance=0.5)

    asked = options(clearance=0.25, steps=9).accuracy(base)

    assert asked == Accuracy(steps=9, method="sampled", clearance=0.25)


def test_depth_of_both_gives_way_to_that_of_one():
    asked = options(max_depth=3, max_depth_b=1).accuracy()

    assert (asked.max_depth_a, asked.max_depth_b) == (3, 1)


@pytest.mark.parametrize("name", [name for name in ASPECTS if ASPECTS[name].concerns == "sampled"])
def test_options_of_sampling_are_refused_without_it(name):
    value = getattr(Accuracy(), name)

    with pytest.raises(UsageError, match="method sampled alone"):
        options(**{name: value}).accuracy()
    assert getattr(options(**{name: value, "method": "sampled"}).accuracy(), name) == value
