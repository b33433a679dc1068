from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from movers.answers import ask, assert_bracket, assert_coherent, bounds
from movers.cases import foreign_mover, rigid_mover
from oracles.screw import Mover
from scenes import cases

from obbcli import Status

STATUSES = {
    "contact": Status.CONTACT,
    "none": Status.SEPARATED,
    "initial": Status.OVERLAP_AT_START,
}
# The files' times are printed doubles of a second.
PRINTED = 4e-16


def benchmark_movers(record: dict[str, Any]) -> tuple[Mover, Mover]:
    """Return a query of the benchmark; vertices and edges are triangles of less than three."""
    points = np.array(record["vertices_t0"])
    rows = ([0, 0, 0], [1, 2, 3]) if record["kind"] == "vf" else ([0, 1, 1], [2, 3, 3])
    shifts = record["displacement_a"], record["displacement_b"]
    a, b = (
        Mover(points[row], np.array([[0, 1, 2]]), velocity=shift)
        for row, shift in zip(rows, shifts, strict=True)
    )
    return a, b


@pytest.mark.parametrize("case", cases.rigid_ccd(), ids=lambda case: str(case["name"]))
def test_certified_case_is_answered_right(case: dict[str, Any]) -> None:
    a, b, duration = rigid_mover(case["A"]), rigid_mover(case["B"]), float(case["T"])
    truth = case["truth"]

    answer = ask(a, b, duration)

    assert_coherent(answer, a, b, duration)
    if case["category"] == "grazing_exact" and answer.status is Status.SEPARATED:
        return
    assert answer.status is STATUSES[truth["status"]]
    if answer.status is Status.CONTACT:
        # The end of an instant's contact is not in the file.
        slack = PRINTED * max(1.0, duration)
        end = (truth["t_hi"] or truth["t_lo"] + 1e-6) + slack
        assert_bracket(answer, truth["t_lo"] - slack, end)


@pytest.mark.parametrize("case", cases.third_party_ccd(), ids=lambda case: str(case["id"]))
def test_case_of_another_project_is_answered_right(case: dict[str, Any]) -> None:
    a, b = foreign_mover(case["body_a"]), foreign_mover(case["body_b"])
    duration = float(case["t_max"])

    answer = ask(a, b, duration)

    assert_coherent(answer, a, b, duration)
    assert (answer.status is not Status.SEPARATED) == case["expected_hit"]
    if case["expected_hit"]:
        assert answer.time == pytest.approx(case["expected_toi"], abs=case["abs_tol"])


def test_benchmark_of_translations_is_answered_exactly() -> None:
    answered = 0
    for record in cases.rigid_translation_subset():
        if "displacement_a_rational" in record:
            continue
        a, b = benchmark_movers(record)
        truth = record["toi_rational"]

        answer = ask(a, b, 1.0)

        answered += 1
        assert_coherent(answer, a, b, 1.0)
        assert (answer.status is Status.SEPARATED) == (truth is None), record
        if truth is not None:
            lo, hi = bounds(answer)
            assert lo <= Fraction(truth)
            assert hi - lo <= Fraction(1, 10**9)
            assert hi >= Fraction(truth)
    assert answered > 200
