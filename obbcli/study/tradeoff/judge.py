"""How far an answer is from the reference, and whether what it claimed is true.

Claims are held against what does not depend on them: the reference's proven bracket, and the
distance of the surfaces at the time that the answer names, on the true paths.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.accuracy import Accuracy
from obbcli.answers.status import Status
from obbcli.motion.body import Body, pose_at
from obbcli.questions.distance import distance

if TYPE_CHECKING:
    from obbcli.answers.contact import FirstContact
    from obbcli.tree.tree import ObbTree

# Of the largest coordinates met: what poses at a time, rounded, may be off.
_ROUNDING = 1e-12
# s; a distance that takes longer leaves a claim unchecked.
_PATIENCE = 2.0


class Judgement(NamedTuple):
    """What came of holding an answer against the reference.

    Attributes:
        is_verdict_wrong: whether it says contact where there is none, or none where there is.
        time_error: s; how much too early (negative) or too late the contact is said to be; 0 within
            the reference's bracket or as near to it as it is wide, and where both are separated;
            None where it cannot be said.
        gap: mesh units; how far apart the surfaces truly are at the time named. None where no time
            is, or the distance took too long.
        claims_checked: how many things that it claims were put to the test.
        faults: those that are not true, each a sentence.
    """

    is_verdict_wrong: bool
    time_error: float | None
    gap: float | None
    claims_checked: int
    faults: tuple[str, ...]


class Judge:
    """Holds answers about two bodies against the reference.

    Args:
        bodies: as they move; their shapes are trees.
        reference: the certified answer.
        clearance: mesh units; what counts as contact.
    """

    def __init__(
        self, bodies: tuple[Body, Body], reference: FirstContact, clearance: float
    ) -> None:
        self._bodies, self._reference, self._clearance = bodies, reference, clearance
        self._gaps: dict[float, tuple[float, float] | None] = {}

    def judge(self, answer: FirstContact) -> Judgement:
        """Return how far off an answer is, and which of its claims are not true."""
        reference = self._reference
        open_answers = Status.UNRESOLVED in (answer.status, reference.status)
        wrong = not open_answers and _touches(answer) != _touches(reference)
        error = None if open_answers or wrong else _time_error(answer, reference)
        checks = [self._contradiction(answer), self._too_late(answer), self._too_early(answer)]
        gap = None
        if answer.time is not None and answer.status is not Status.UNRESOLVED:
            gap, near = self._nearness(answer, answer.time)
            checks.append(near)
        faults = tuple(text for text in checks if text)
        return Judgement(wrong, error, gap, sum(text is not None for text in checks), faults)

    def _contradiction(self, answer: FirstContact) -> str | None:
        """Hold one proof against another: of separation, and of contact."""
        reference = self._reference
        for proof, other, names in (
            (answer, reference, ("it", "the reference")),
            (reference, answer, ("the reference", "it")),
        ):
            if proof.status is Status.SEPARATED and _claims_truth(proof):
                is_broken = self._proves_contact(other)
                text = f"{names[0]} proves separation, and {names[1]} proves contact"
                return text if is_broken else ""
        return None

    def _too_late(self, answer: FirstContact) -> str | None:
        """Hold its proof that there is no contact before lo against the reference's contact."""
        low, high = _low(answer), self._proven_end(self._reference)
        if low is None or high is None or not _proves_low(answer):
            return None
        return f"no contact before {low!r} s, and there is one by {high!r} s" if low > high else ""

    def _too_early(self, answer: FirstContact) -> str | None:
        """Hold its proof of contact by hi against the reference's that there is none before lo."""
        low, high = _low(self._reference), self._proven_end(answer)
        if low is None or high is None:
            return None
        return f"contact by {high!r} s, and there is none before {low!r} s" if high < low else ""

    def _nearness(self, answer: FirstContact, low: float) -> tuple[float | None, str | None]:
        """Hold the distance that it allows at contact against the true one."""
        assert answer.time_bounds is not None
        end = answer.time_bounds[1]
        time = low if end is None else end
        bounds = self._gap_at(time)
        if bounds is None:
            return None, None
        allowed = answer.error_bound + (answer.distance or 0.0)
        if end is None:  # of boxes alone the clearance is no part of the bound
            allowed += self._clearance
        if bounds[0] > allowed + self._rounding(time):
            text = f"at {time!r} s the surfaces are {bounds[0]!r} apart, and at most {allowed!r}"
            return bounds[1], f"{text} is claimed"
        return bounds[1], ""

    def _proves_contact(self, answer: FirstContact) -> bool:
        """Return whether contact is shown by points or triangles, on the true paths."""
        if not _touches(answer) or not _claims_truth(answer) or answer.evidence == "boxes":
            return False
        return answer.distance is not None and answer.distance <= self._clearance

    def _proven_end(self, answer: FirstContact) -> float | None:
        if not self._proves_contact(answer) or answer.time_bounds is None:
            return None
        return answer.time_bounds[1]

    def _gap_at(self, time: float) -> tuple[float, float] | None:
        """Return proven bounds on the distance of the surfaces at a time; None: took too long."""
        if time not in self._gaps:
            a, b = (Body(body.shape, pose_at(body, time, _tree(body))) for body in self._bodies)
            bounds = distance(a, b, Accuracy(timeout=_PATIENCE)).bounds
            is_known = bounds[1] - bounds[0] <= 1e-6 * bounds[1]
            self._gaps[time] = bounds if is_known else None
        return self._gaps[time]

    def _rounding(self, time: float) -> float:
        """Return what the distance at a time may be off since poses and times are rounded."""
        reach = [time * float(np.linalg.norm(body.motion.top_velocity)) for body in self._bodies]
        for body in self._bodies:
            pose = pose_at(body, time, _tree(body))
            reach += [
                float(np.abs(pose.translation).max()),
                float(np.abs(_tree(body).bounds).max()),
            ]
        return _ROUNDING * max(reach)


def _tree(body: Body) -> ObbTree:
    tree: ObbTree = body.shape  # type: ignore[assignment]  # bodies of a study are over trees
    return tree


def _touches(answer: FirstContact) -> bool:
    return answer.status in (Status.CONTACT, Status.OVERLAP_AT_START)


def _claims_truth(answer: FirstContact) -> bool:
    """Return whether the answer is about the true paths: not sampled, or off by 0."""
    is_sampled = answer.approximate and answer.evidence in (None, "sampled")
    return not is_sampled or answer.error_bound == 0


def _proves_low(answer: FirstContact) -> bool:
    return answer.evidence != "sampled" or answer.error_bound == 0


def _low(answer: FirstContact) -> float | None:
    return None if answer.time_bounds is None else answer.time_bounds[0]


def _time_error(answer: FirstContact, reference: FirstContact) -> float:
    """Return by how many seconds the contact is said too early (negative) or too late.

    What is no further from the reference's bracket than this is wide is not told from the truth.
    """
    if answer.time is None or reference.time_bounds is None:
        return 0.0
    low, high = reference.time_bounds
    end = low if high is None else high
    error = min(answer.time - low, 0.0) or max(answer.time - end, 0.0)
    return error if abs(error) > end - low else 0.0
