"""Holds answers about bodies at rest against the narrowest: brackets overlap, verdicts agree."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from obbcli.answers.overlap import Overlap

if TYPE_CHECKING:
    from obbcli.answers.distance import Distance
    from obbcli.answers.overlap import Bounds
    from obbcli.questions.overlap.asked import Asked

_NUMBERS = ("distance", "thickness", "protrusion_a", "protrusion_b", "volume")


def brackets(answer: Distance | Overlap) -> dict[str, Bounds]:
    """Return the brackets of an answer by their names; ends that are not known are infinite."""
    if not isinstance(answer, Overlap):
        return {"distance": answer.bounds}
    found = {name: getattr(answer, name) for name in _NUMBERS}
    return {
        name: (one.bounds[0], math.inf if one.bounds[1] is None else one.bounds[1])
        for name, one in found.items()
        if one is not None
    }


def contradictions(
    answer: Distance | Overlap, asked: Asked, reference: Distance | Overlap
) -> tuple[int, list[str]]:
    """Return how many claims were checked, and those that the reference contradicts."""
    own, known = brackets(answer), brackets(reference)
    shared = [name for name in own if name in known]
    faults = [
        f"{name} is said to be in {own[name]}, and is in {known[name]}"
        for name in shared
        if own[name][0] > known[name][1] or known[name][0] > own[name][1]
    ]
    checked = len(shared)
    if not isinstance(answer, Overlap) or not isinstance(reference, Overlap):
        return checked, faults
    if "unresolved" not in (answer.relation, reference.relation):
        checked += 1
        if answer.relation != reference.relation:
            faults.append(f"is said to be {answer.relation}, and is {reference.relation}")
    if answer.deeper is not None and asked.deeper_than is not None:
        checked += 1
        depths = [known[name] for name in known if name not in ("distance", "volume")]
        room = asked.deeper_than + 2.0 * answer.band.slack
        if answer.deeper and all(high < asked.deeper_than for _, high in depths):
            faults.append(f"is said to be deeper than {asked.deeper_than!r}, and is not")
        if not answer.deeper and any(low > room for low, _ in depths):
            faults.append(f"is said to be no deeper than {asked.deeper_than!r}, and is")
    return checked, faults
