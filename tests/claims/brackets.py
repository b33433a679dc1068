"""What every bracket of a time of contact must be."""

from __future__ import annotations

import mpmath

from obbcli import FirstContact, Status


def bounds(answer: FirstContact) -> tuple[float, float]:
    """Return a contact's bracket, which is one, with `time` at its start."""
    assert answer.time_bounds is not None
    low, high = answer.time_bounds
    assert high is not None
    assert answer.time == low
    assert low <= high
    return low, high


def assert_at(answer: FirstContact, time: float, width: float) -> None:
    """Fail unless the bracket of a contact is narrow and at a time."""
    assert answer.status is Status.CONTACT
    low, high = bounds(answer)
    assert high - low <= width
    assert low - width <= time <= high + width


def assert_holds(answer: FirstContact, truth: mpmath.mpf) -> tuple[float, float]:
    """Fail unless the bracket of a contact holds the true time; return it."""
    assert answer.status is Status.CONTACT
    low, high = bounds(answer)
    with mpmath.workdps(60):
        assert mpmath.mpf(low) <= truth <= mpmath.mpf(high)
    return low, high
