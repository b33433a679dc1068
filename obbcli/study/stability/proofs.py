"""What answers prove, on one clock, and when two of them contradict each other."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

from obbcli.answers.status import Status

if TYPE_CHECKING:
    from obbcli.answers.contact import Contact
    from obbcli.study.stability.world import Pair


class Proofs(NamedTuple):
    """What an answer proves, in exact seconds of the question itself.

    Attributes:
        free: no contact before this.
        is_free: whether there is none in the whole interval.
        end: of the interval.
        met: contact by then; None where none is proven.
        gap: mesh units of its question: how far apart the surfaces may be at `met`.
    """

    free: Fraction
    is_free: bool
    end: Fraction
    met: Fraction | None
    gap: float

    def denies(self, other: Proofs) -> bool:
        """Return whether contact that the other proves is at a time that this proves free."""
        if other.met is None or other.met > self.end:
            return False
        return self.is_free or other.met < self.free

    @classmethod
    def of(cls, answer: Contact, pair: Pair, clock: Fraction) -> Proofs:
        """Return what the answer to a question proves; its times are divided by `clock`."""
        end = Fraction(pair.duration) / clock
        is_free = answer.status is Status.SEPARATED
        low, high = answer.time_bounds or (0.0, None)
        is_proof = (
            answer.status in (Status.CONTACT, Status.OVERLAP_AT_START) and not answer.approximate
        )
        met = Fraction(high) / clock if is_proof and high is not None else None
        free = end if is_free else Fraction(low) / clock
        return cls(free, is_free, end, met, answer.distance or 0.0)

    def is_same_as(self, other: Proofs) -> bool:
        """Return whether two answers of one status have the same times, in every bit."""
        if self.is_free:
            return True
        return (self.free, self.met) == (other.free, other.met)

    def difference(self, other: Proofs) -> float | None:
        """Return how far the lower ends of two brackets are apart, s; None where there is none."""
        if self.is_free or other.is_free:
            return None
        return float(abs(self.free - other.free))


def on_clock(answer: Contact, clock: Fraction) -> tuple[float, float | None] | None:
    """Return an answer's bracket, s, divided by `clock`."""
    if answer.time_bounds is None:
        return None
    low, high = answer.time_bounds
    last = None if high is None else float(Fraction(high) / clock)
    return float(Fraction(low) / clock), last
