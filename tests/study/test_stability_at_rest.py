"""Distance and overlap at the extremes: brackets agree up to what the change did to the input."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from meshes.solids import shifted
from movers.meshes import box

import obbcli
from obbcli import Accuracy, Body, Mesh, MotionError, Pose, stability
from obbcli.study.stability import at_rest
from obbcli.study.stability.at_rest import RestBattery

UNIT = box((0, 0, 0), (1, 1, 1))
TURN = Pose(rotation=[0.3, -0.2, 0.9], translation=[0.5, 0.4, 0.3])
PAIRS = {
    "turned cubes": (Mesh(*UNIT), Body(Mesh(*UNIT), TURN)),
    "flush": (Mesh(*UNIT), Mesh(*box((1, 0.25, 0.25), (2, 3, 3)))),
    "apart": (Mesh(*UNIT), Mesh(*shifted(UNIT, (3, 0.5, 0)))),
}


@pytest.mark.parametrize("ask", ["distance", "overlap"])
@pytest.mark.parametrize("name", PAIRS)
def test_no_bracket_contradicts_another(name, ask) -> None:
    found = stability(*PAIRS[name], ask=ask)

    assert [(row.family, row.extreme, row.reason) for row in found.broken] == []
    families = {row.family for row in found.rows}
    assert {"scale by 10^k", "rotate the world", "swap A and B", "split triangles"} <= families
    (swap,) = (row for row in found.rows if row.family == "swap A and B")
    assert swap.outcome == "same"
    assert swap.expected == ("same bits" if ask == "overlap" else "within bound")
    names = {"distance"} if ask == "distance" else {"thickness", "protrusion_a", "protrusion_b"}
    assert all(names <= row.bounds.keys() for row in found.rows if row.outcome != "refused")


def test_bracket_that_is_off_is_broken(monkeypatch) -> None:
    told = at_rest._told

    def off(answer, length):
        found = told(answer, length)
        if length == 10.0:
            low, high = found.bounds["thickness"]
            found.bounds["thickness"] = low * 1.1, high * 1.1
        return found

    monkeypatch.setattr(at_rest, "_told", off)
    found = stability(*PAIRS["turned cubes"], ask="overlap")

    assert [(row.family, row.extreme) for row in found.broken] == [("scale by 10^k", "1e1")]
    assert found.broken[0].reason.startswith("thickness: brackets are")


def test_other_relation_of_the_same_input_is_broken(monkeypatch) -> None:
    told = at_rest._told

    def off(answer, length):
        found = told(answer, length)
        return found._replace(relation="touching") if length == 2.0 else found

    monkeypatch.setattr(at_rest, "_told", off)
    found = stability(*PAIRS["turned cubes"], ask="overlap")

    assert [(row.family, row.extreme) for row in found.broken] == [("scale by 2^k", "2^1")]


def test_other_bits_of_swapped_bodies_are_broken(monkeypatch) -> None:
    swapped = at_rest._swapped

    def off(told):
        found = swapped(told)
        low, high = found.bounds["thickness"]
        found.bounds["thickness"] = math.nextafter(low, 0), high
        return found

    monkeypatch.setattr(at_rest, "_swapped", off)
    found = stability(*PAIRS["turned cubes"], ask="overlap")

    assert [row.family for row in found.broken] == ["swap A and B"]


def test_limit_leaves_extremes_open() -> None:
    battery = RestBattery(*PAIRS["turned cubes"], None, "overlap")
    battery._pair = replace_limit(battery._pair, 1)
    battery._left = type(battery._left)(at_rest._plan(battery._pair, "overlap"))

    row = battery.advance()

    assert (row.outcome, row.held) == ("unresolved", True)


def replace_limit(pair, most):
    """Return a question that may take so many steps."""
    return pair._replace(accuracy=replace(pair.accuracy, max_iterations=most))


@pytest.mark.parametrize(
    ("words", "where"),
    [
        ({"ask": "clearance"}, "ask"),
        ({"ask": "overlap", "duration": 1.0}, "duration"),
        ({"ask": "overlap", "accuracy": Accuracy(max_depth_a=2)}, "max_depth_a"),
    ],
)
def test_what_says_nothing_is_refused(words, where) -> None:
    with pytest.raises(MotionError) as caught:
        obbcli.stability(*PAIRS["apart"], **words)

    assert caught.value.where == where
