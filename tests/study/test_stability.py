"""`stability` over sample meshes: every promise holds, and a lie is found out."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

import obbcli
from obbcli import Accuracy, Body, Motion, MotionError, Pose, Status
from obbcli.study.stability import battery, samples
from obbcli.study.stability.battery import Battery

if TYPE_CHECKING:
    from obbcli.study.stability.extremes import Changed

SAMPLES = Path(__file__).resolve().parents[2] / "sample_meshes"
FAMILIES = [
    "scale by 2^k",
    "scale by 10^k",
    "shift the world",
    "common velocity",
    "rotate the world",
    "swap A and B",
    "permute triangles",
    "permute vertices",
    "split triangles",
    "repeat triangles",
    "reverse windings",
    "time by 2^k",
    "time by 10^k",
    "cut the duration",
    "angular speed",
    "tilt B",
    "round coordinates",
]


def sample(name: str, pose: Pose | None = None, **motion: object) -> Body:
    return Body(SAMPLES / name, pose or Pose(), Motion(**motion))  # type: ignore[arg-type]


def links() -> tuple[Body, Body]:
    return sample("chain_link_a.off", linear_velocity=[0, 0, -5]), sample("chain_link_b.ply")


QUESTIONS = {
    "sliding": links(),
    "turning": (
        sample("finger_left.off", angular_velocity=[0.3, 0.2, 0.1], linear_velocity=[0, -10, 0]),
        sample("workpiece.obj", Pose(rotation=[0, 0, 1e-3]), angular_velocity=[0.2, -0.1, 0]),
    ),
    "at rest": (sample("housing.stl"), sample("board.vtk")),
    "overlapping": (sample("degenerate.ply"), sample("degenerate.ply")),
    "apart": (sample("board.vtk", angular_velocity=[0, 0, 9]), sample("chain_link_a.off")),
}


@pytest.mark.parametrize("name", QUESTIONS)
def test_answers_hold_at_all_extremes(name: str) -> None:
    study = obbcli.stability(*QUESTIONS[name])

    assert not study.broken, study.broken[0]
    assert all(row.held for row in study.rows)
    assert [family for family in FAMILIES if family in {row.family for row in study.rows}] == list(
        dict.fromkeys(row.family for row in study.rows)
    )
    if name == "turning":
        assert {row.family for row in study.rows} == set(FAMILIES)


def test_without_rotation_what_rounds_nothing_changes_no_bit() -> None:
    study = obbcli.stability(*links())

    lossless = [row for row in study.rows if row.expected == "same bits"]
    assert {row.family for row in lossless} >= {
        "scale by 2^k",
        "common velocity",
        "swap A and B",
        "permute triangles",
        "repeat triangles",
        "reverse windings",
        "time by 2^k",
    }
    assert {row.outcome for row in lossless} == {"same"}
    assert all(row.time_bounds == study.answer.time_bounds for row in lossless)


def test_progress_counts_to_the_end() -> None:
    told: list[tuple[int, int, str]] = []

    study = obbcli.stability(
        *QUESTIONS["at rest"], progress=lambda done, count, name: told.append((done, count, name))
    )

    assert [done for done, _, _ in told] == list(range(len(study.rows)))
    assert {count for _, count, _ in told} == {len(study.rows)}
    assert told[0][2] == "scale by 2^k, 2^1"


@pytest.mark.parametrize("families", [{"shift the world"}, {"tilt B"}, {"round coordinates"}])
def test_answers_differ_by_what_the_bounds_allow_and_not_by_less(
    families: set[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def narrow(extreme: battery.Extreme) -> battery.Extreme:
        def change() -> Changed:
            made = extreme.change()
            return made._replace(bound=made.bound * 1e-3)

        return extreme._replace(change=change)

    plan = battery.plan
    monkeypatch.setattr(
        battery,
        "plan",
        lambda *asked: [narrow(one) for one in plan(*asked) if one.family in families],
    )

    study = obbcli.stability(*links())

    assert study.broken
    assert {row.outcome for row in study.broken} == {"broken"}


@pytest.mark.parametrize("name", ["sliding", "turning"])
@pytest.mark.parametrize("lie", ["separated", "late", "early"])
def test_an_answer_that_is_wrong_is_found_out(
    name: str, lie: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = Battery(*QUESTIONS[name])
    ask = battery.first_contact

    def wrong(*question: object) -> obbcli.FirstContact:
        answer = ask(*question)  # type: ignore[arg-type]
        low, high = answer.time_bounds or (0.0, 0.0)
        if answer.status is not Status.CONTACT or high is None:
            return answer
        if lie == "separated":
            return replace(answer, status=Status.SEPARATED, time=None, time_bounds=None)
        factor = 1.01 if lie == "late" else 0.99
        return replace(answer, time_bounds=(low * factor, high * factor))

    monkeypatch.setattr(battery, "first_contact", wrong)
    monkeypatch.setattr(samples, "first_contact", wrong)
    while not asked.is_finished:
        asked.advance()

    broken = {row.family for row in asked.result().broken}
    assert {"swap A and B", "permute triangles", "reverse windings", "common velocity"} <= broken
    if name == "turning":
        assert "angular speed" in broken


def test_refusal_of_what_doubles_hold_is_broken(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*question: object) -> obbcli.FirstContact:
        raise MotionError("motion", "is refused")

    asked = Battery(*links())
    monkeypatch.setattr(battery, "first_contact", refuse)

    row = asked.advance()

    assert (row.outcome, row.held, row.status) == ("broken", False, None)
    assert row.reason == "motion: is refused"


def test_interrupt_leaves_an_extreme_to_be_tried(monkeypatch: pytest.MonkeyPatch) -> None:
    def stop(*question: object) -> obbcli.FirstContact:
        raise KeyboardInterrupt

    asked = Battery(*links())
    asked.advance()
    with monkeypatch.context() as patch:
        patch.setattr(battery, "first_contact", stop)
        with pytest.raises(KeyboardInterrupt):
            asked.advance()

    assert len(asked.rows) == 1
    assert asked.advance().extreme == "2^-1"


def test_limit_is_said_and_breaks_nothing() -> None:
    study = obbcli.stability(*QUESTIONS["turning"], accuracy=Accuracy(max_iterations=3))

    assert study.answer.status is Status.UNRESOLVED
    assert not study.broken
    assert any(row.outcome == "unresolved" and "3 steps" in row.reason for row in study.rows)


def test_tolerances_depths_and_clearance_hold_too() -> None:
    for accuracy in (
        Accuracy(clearance=0.5),
        Accuracy(distance_tolerance=0.1, time_tolerance=1e-3),
        Accuracy(max_depth_a=3, max_depth_b=4),
    ):
        assert not obbcli.stability(*links(), accuracy=accuracy).broken


@pytest.mark.parametrize(
    ("a", "accuracy", "where"),
    [
        (links()[0], Accuracy(method="sampled"), "method"),
        (
            Body(
                SAMPLES / "gear.stl",
                motion=Motion.through([0, 1], [Pose(), Pose(translation=[1, 0, 0])]),
            ),
            None,
            "motion of a",
        ),
    ],
)
def test_what_has_no_extremes_is_refused(a: Body, accuracy: Accuracy | None, where: str) -> None:
    with pytest.raises(MotionError) as caught:
        obbcli.stability(a, links()[1], accuracy=accuracy)

    assert caught.value.where == where


def test_mesh_at_the_end_of_the_doubles_is_refused_beyond_it_alone() -> None:
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]]) * 1e305
    a = obbcli.Mesh(corners, [[0, 1, 2]])
    b = obbcli.Mesh(corners + np.array([0, 0, 1e304]), [[0, 1, 2]])

    study = obbcli.stability(a, b)

    assert not study.broken
    refused = {row.extreme for row in study.rows if row.outcome == "refused"}
    assert {"2^100", "1e30"} <= refused
    assert "2^-100" not in refused
