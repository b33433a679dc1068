"""`tradeoff`: rows are what `first_contact` answers, errors what closed forms say, claims true."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest
from mesh_files.cube_files import CUBE_FACES, cube
from meshes.surfaces import sphere

import obbcli
from obbcli import Accuracy, Body, Mesh, Motion, MotionError, ObbTree, Pose, Status
from obbcli.study.tradeoff import measuring
from obbcli.study.tradeoff.measuring import Study
from obbcli.study.tradeoff.settings import Scale
from obbcli.study.tradeoff.taking_turns import fair_part
from obbcli.tree.options import BuildOptions

if TYPE_CHECKING:
    from collections.abc import Iterator

# A corner of a cube turns into its neighbour: where, by the law of sines.
TURN_GAP = 0.1
TURN_TIME = math.pi / 4 - math.acos(0.6 / math.sqrt(0.5))


def cubes_turning() -> tuple[Body, Body]:
    """Return a cube that turns about its center, and one beside it."""
    mesh = Mesh(np.array(cube()), np.array(CUBE_FACES))
    turning = Body(mesh, motion=Motion(angular_velocity=[0, 0, 1]))
    return turning, Body(mesh, Pose(translation=[1 + TURN_GAP, 0, 0]))


@pytest.fixture(scope="module", autouse=True)
def _few_steps_and_turns() -> Iterator[None]:
    """Leave out what takes seconds, so that no budget ends a study, however slow the machine."""
    whole = measuring.plan

    def short(*args, **kwargs):
        return [one for one in whole(*args, **kwargs) if one.accuracy.steps <= 1024]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(measuring, "plan", short)
        patch.setattr(measuring, "_EARLY_ROUNDS", 1)
        patch.setattr(measuring, "_ROUNDS", 3)
        yield


@pytest.fixture(scope="module")
def turned() -> obbcli.Tradeoff:
    """Return the trade of cubes that turn."""
    found = obbcli.tradeoff(*cubes_turning(), 1.0, budget=1000.0)
    assert not found.unreached
    assert {row.warm.rounds for row in found.rows} == {3}
    return found


def test_rows_are_what_first_contact_answers(turned):
    a, b = cubes_turning()

    for row in turned.rows:
        trees = [ObbTree.build(body.shape, **row.build) for body in (a, b)]
        bodies = (Body(t, o.pose, o.motion) for t, o in zip(trees, (a, b), strict=True))
        alone = obbcli.first_contact(*bodies, 1.0, row.accuracy)
        assert replace(alone, stats=None) == replace(row.answer, stats=None)
        assert alone.stats.box_tests == row.answer.stats.box_tests


def test_errors_are_those_of_the_closed_form(turned):
    sampled = [row for row in turned.rows if row.accuracy.method == "sampled"]
    assert {row.accuracy.steps for row in sampled} >= {1, 4, 16, 64, 256, 1024}
    for row in turned.rows:
        if row.answer.status is Status.SEPARATED:
            assert row.is_verdict_wrong
            assert row.error == math.inf
            continue
        assert not row.is_verdict_wrong
        assert row.time_error == pytest.approx(row.answer.time - TURN_TIME, abs=2e-12)
        if row.accuracy.method == "sampled":
            # No sampled frame but the first of the step in which the true contact lies, or later.
            assert 0 <= row.time_error <= 1 / row.accuracy.steps + 1e-12
        else:
            assert row.time_error <= 0


def test_gap_is_the_true_distance_at_the_time_said(turned):
    for row in turned.rows:
        if row.answer.time is None:
            continue
        bounds = row.answer.time_bounds
        time = bounds[0] if bounds[1] is None else bounds[1]
        reach = 0.5 + math.sqrt(0.5) * math.cos(math.pi / 4 - min(time, math.pi / 4))
        assert row.gap == pytest.approx(max(0.0, 1 + TURN_GAP - reach), abs=1e-12)


def test_all_claims_are_checked_and_true(turned):
    assert turned.faulty == ()
    for row in turned.rows:
        is_sampled = row.accuracy.method == "sampled"
        assert row.claims_checked >= (0 if row.is_verdict_wrong else 1 if is_sampled else 2)


def test_reference_is_tighter_than_any_row(turned):
    low, high = turned.reference.time_bounds

    assert low <= TURN_TIME <= high or abs(low - TURN_TIME) < 1e-15
    assert high - low <= 1.001e-12
    assert turned.reference_accuracy.time_tolerance == 1e-12


def test_grid_holds_what_it_says(turned):
    rows = turned.rows
    assert {row.build["fit"] for row in rows} == {
        "triangles", "points", "hull", "min-volume", "axis-aligned",
    }  # fmt: skip
    assert {row.build["split"] for row in rows} == {"median", "center", "compact"}
    assert {row.build["leaf_size"] for row in rows} >= {1, 2, 4, 8, 16}
    assert {row.accuracy.integrator for row in rows} == {"exact", "euler", "rk4"}
    assert {row.accuracy.leaves for row in rows} == {"triangles", "boxes"}
    assert {row.accuracy.max_depth_a for row in rows} >= {None, 2, 4}
    assert {row.accuracy.time_tolerance for row in rows} == {None, 1e-3, 1e-6}
    keys = [(tuple(row.build.values()), row.accuracy) for row in rows]
    assert len(set(keys)) == len(keys)


def test_steps_longer_than_a_turn_are_measured():
    a, b = cubes_turning()
    fast = Body(a.shape, motion=Motion(angular_velocity=[0, 0, 40]))

    found = obbcli.tradeoff(fast, b, 1.0, budget=1000.0)

    least = min((row for row in found.rows if row.accuracy.method == "sampled"),
                key=lambda row: row.accuracy.steps)  # fmt: skip
    assert 40 / least.accuracy.steps > 2 * math.pi
    assert not found.faulty


def test_sphere_falling_on_a_plate_errs_by_nothing():
    surface = sphere(500)
    ball = Mesh(surface.vertices, surface.faces)
    plate = Mesh(np.array([[-2.0, -2, 0], [2, -2, 0], [0, 4, 0]]), np.array([[0, 1, 2]]))
    height = 1 - float(ball.vertices[:, 2].min())
    falling = Body(ball, Pose(translation=[0, 0, height]), Motion([0, 0, -2.0]))

    found = obbcli.tradeoff(falling, plate, 1.0, budget=1000.0)

    assert found.reference.time == pytest.approx(0.5, abs=1e-15)
    sampled = [row for row in found.rows if row.accuracy.method == "sampled"]
    # Without rotation one step is exact.
    assert [row.accuracy.steps for row in sampled] == [1]
    assert sampled[0].error == 0
    assert not found.faulty


def test_bodies_at_rest_have_no_steps():
    mesh = Mesh(np.array(cube()), np.array(CUBE_FACES))

    found = obbcli.tradeoff(mesh, Body(mesh, Pose(translation=[1.5, 0, 0])), budget=1000.0)

    assert found.reference.status is Status.SEPARATED
    assert found.duration == 0
    assert {row.accuracy.method for row in found.rows} == {"certified"}
    assert {row.error for row in found.rows if row.accuracy.leaves == "triangles"} >= {0.0}


def test_setting_of_the_user_is_measured_and_limits_are_shared():
    a, b = cubes_turning()
    own = Accuracy(method="sampled", steps=7, clearance=0.05, max_iterations=123456)

    found = obbcli.tradeoff(a, b, 1.0, own, budget=1000.0)

    assert found.rows[1].accuracy == own
    assert {row.accuracy.clearance for row in found.rows} == {0.05}
    assert {row.accuracy.max_iterations for row in found.rows} == {123456}
    assert not found.faulty


def test_bodies_that_came_as_trees_keep_them():
    a, b = cubes_turning()
    trees = [
        Body(ObbTree.build(body.shape, fit="points"), body.pose, body.motion) for body in (a, b)
    ]

    found = obbcli.tradeoff(*trees, 1.0, budget=1000.0)

    assert [row.build for row in found.rows] == [{}] * len(found.rows)


def test_limit_that_ends_the_reference_says_that_nothing_is_known():
    with pytest.raises(obbcli.UnresolvedError, match="certified answer") as caught:
        obbcli.tradeoff(*cubes_turning(), 1.0, Accuracy(max_iterations=1), budget=1000.0)

    assert 0 <= caught.value.time <= TURN_TIME


def test_budget_of_almost_nothing_gives_the_reference_and_says_what_is_missing(monkeypatch):
    study = Study(*cubes_turning(), 1.0, budget=1000.0)
    monkeypatch.setattr(Study, "_left", property(lambda self: 0.0 if self.has_reference else 9.0))

    study.run()
    found = study.result()

    assert found.reference.time == pytest.approx(TURN_TIME, abs=1e-12)
    assert found.rows == ()
    planned = measuring.plan(
        Accuracy(), Scale(1.0, math.sqrt(3), turns=True, levels=6), varies_trees=True
    )
    assert len(found.unreached) == len(list(planned))
    assert {one.why for one in found.unreached} == {"the budget ended before"}


def test_interrupt_keeps_what_was_measured(monkeypatch):
    study = Study(*cubes_turning(), 1.0, budget=1000.0)
    whole, calls = Study._timed, []

    def interrupted(self, *args):
        calls.append(args)
        if len(calls) == 5:
            raise KeyboardInterrupt
        return whole(self, *args)

    monkeypatch.setattr(Study, "_timed", interrupted)

    with pytest.raises(KeyboardInterrupt):
        study.run()

    found = study.result()
    assert len(found.rows) == 3
    assert {row.warm.rounds for row in found.rows} == {0}
    assert any(row.on_front for row in found.rows)


def test_steps_that_an_integrator_cannot_follow_are_listed_with_the_reason():
    a, b = cubes_turning()
    fast = Body(a.shape, motion=Motion(angular_velocity=[0, 0, 1e150]))

    study = Study(fast, b, 1.0, Accuracy(max_iterations=1000), budget=1000.0)
    study._first_calls = lambda *_args: None  # the reference alone
    study.run()

    assert not study.has_reference
    assert study.result().reference.status is Status.UNRESOLVED


@pytest.mark.parametrize("budget", [-1.0, math.nan, math.inf, "ten"])
def test_budgets_that_are_no_number_are_refused(budget):
    with pytest.raises(MotionError) as caught:
        obbcli.tradeoff(*cubes_turning(), budget=budget)

    assert caught.value.where == "budget"


def test_slow_settings_take_no_more_than_their_part():
    assert fair_part([1.0, 2.0, 3.0], 10.0) == math.inf
    assert fair_part([1.0, 100.0, 100.0], 11.0) == 5.0
    assert fair_part([], 1.0) == math.inf


def test_default_build_is_that_of_trees():
    mesh = Mesh(np.array(cube()), np.array(CUBE_FACES))
    tree = ObbTree.build(mesh)

    assert (tree.fit, tree.split, tree.leaf_size, tree.max_depth) == tuple(BuildOptions())
