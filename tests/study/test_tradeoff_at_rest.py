"""What a tolerance costs of distances and overlaps: every bracket is held against the narrowest."""

from __future__ import annotations

import pytest
from movers.meshes import box

from obbcli import Accuracy, Body, Mesh, MotionError, Pose, tradeoff
from obbcli.study.tradeoff import rest_judge

UNIT = box((0, 0, 0), (1, 1, 1))
PAIR = Mesh(*UNIT), Body(Mesh(*UNIT), Pose([0.3, -0.2, 0.9], [0.5, 0.4, 0.3]))
FAR = Mesh(*UNIT), Body(Mesh(*UNIT), Pose([0.3, -0.2, 0.9], [5, 0.4, 0.3]))


def test_overlap_is_asked_at_every_tolerance_and_decided_beside_its_depth() -> None:
    found = tradeoff(*PAIR, ask="overlap", budget=30)

    assert found.faulty == ()
    assert found.unreached == ()
    words = [row.words[0] for row in found.rows]
    assert (words.count("--tolerance"), words.count("--deeper-than")) == (6, 4)
    assert all(row.claims_checked >= 2 for row in found.rows)
    for row in found.rows:
        if row.words[0] == "--tolerance":
            deepest = max(high for _, high in row.bounds.values())
            assert row.width <= float(row.words[1]) * deepest + 1e-6
        else:
            assert row.width is None


def test_distance_is_asked_at_every_tolerance_and_depth() -> None:
    found = tradeoff(*FAR, ask="distance", budget=30)

    assert found.faulty == ()
    assert found.rows[0].words == ()
    assert {row.words[0] for row in found.rows if row.words} == {
        "--distance-tolerance",
        "--max-depth",
    }
    assert any(row.on_front for row in found.rows)
    assert found.reference.bounds[1] - found.reference.bounds[0] <= 1e-12


def test_bracket_beside_the_narrowest_is_a_fault(monkeypatch) -> None:
    brackets = rest_judge.brackets
    calls = []

    def off(answer):
        found = brackets(answer)
        calls.append(answer)
        if len(calls) == 1:
            low, high = found["thickness"]
            found["thickness"] = 2 * high, 2 * high + low
        return found

    monkeypatch.setattr(rest_judge, "brackets", off)
    found = tradeoff(*PAIR, ask="overlap", budget=30)

    assert [len(row.faults) for row in found.faulty] == [1]
    assert found.faulty[0].faults[0].startswith("thickness is said to be in")


def test_budget_that_is_spent_leaves_settings_out() -> None:
    found = tradeoff(*PAIR, ask="overlap", budget=0.0)

    assert len(found.rows) == 1
    assert len(found.unreached) == 9


@pytest.mark.parametrize(
    ("words", "where"),
    [
        ({"ask": "clearance"}, "ask"),
        ({"ask": "overlap", "duration": 1.0}, "duration"),
        ({"ask": "overlap", "budget": -1}, "budget"),
        ({"ask": "overlap", "accuracy": Accuracy(leaves="boxes")}, "leaves"),
    ],
)
def test_what_says_nothing_is_refused(words, where) -> None:
    with pytest.raises(MotionError) as caught:
        tradeoff(*PAIR, **words)

    assert caught.value.where == where
