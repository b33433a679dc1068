"""A scene says of every pair what its own question says, bit for bit, and leaves none out."""

from __future__ import annotations

from itertools import combinations

import pytest
from scenes.random_scenes import MESHES, asked, one_by_one, plain, random_scene

import obbcli.scene.rounds
from obbcli import (
    Accuracy,
    Body,
    Mesh,
    Motion,
    Pose,
    Scene,
    SceneContact,
    Status,
    contacts,
    first_contact,
)

KINDS = {
    "default": {},
    "clearance": {"clearance": 0.5},
    "near": {"distance_tolerance": 0.25},
    "coarse": {"leaves": "boxes", "max_depth_b": 3},
    "root boxes": {"max_depth_a": 0, "max_depth_b": 0},
    "wide brackets": {"time_tolerance": 0.1},
    "sampled": {"method": "sampled", "steps": 7},
    "sampled coarsely": {"method": "sampled", "steps": 5, "max_depth_a": 2, "clearance": 0.1},
    "by Runge and Kutta": {"method": "sampled", "steps": 40, "integrator": "rk4"},
    "few steps": {"max_iterations": 40},
}


def answers(scene: Scene) -> list[tuple[object, ...]]:
    """Return what a scene says, in its order."""
    return [plain(one.body_a, one.body_b, one.contact) for one in scene.first_contacts()]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(4))
def test_scene_answers_what_all_pairs_answer(kind: str, seed: int) -> None:
    scene = random_scene(seed, accuracy=Accuracy(**KINDS[kind]))

    assert answers(scene) == one_by_one(scene)


@pytest.mark.parametrize("seed", range(10, 16))
def test_crowded_scene_answers_what_all_pairs_answer(seed: int) -> None:
    scene = random_scene(seed, count=16, width=4.0)

    assert answers(scene) == one_by_one(scene)


@pytest.mark.parametrize("seed", range(20, 24))
def test_scattered_scene_answers_what_all_pairs_answer(seed: int) -> None:
    scene = random_scene(seed, count=24, width=30.0, duration=2.5)

    assert answers(scene) == one_by_one(scene)


@pytest.mark.parametrize("seed", range(30, 33))
def test_many_turns_answer_what_all_pairs_answer(seed: int) -> None:
    scene = random_scene(seed, count=8, width=12.0, turns=50.0)

    assert answers(scene) == one_by_one(scene)


@pytest.mark.parametrize("duration", [0.0, 1e-300, 3e4])
def test_any_duration_answers_what_all_pairs_answer(duration: float) -> None:
    scene = random_scene(3, width=3.0, duration=duration, accuracy=Accuracy(max_iterations=2000))

    assert answers(scene) == one_by_one(scene)


@pytest.mark.parametrize("seed", range(6))
def test_pairs_add_up(seed: int) -> None:
    scene = random_scene(seed, count=20, width=12.0)
    found = scene.first_contacts()

    count = len(list(found))

    stats = found.stats
    assert stats.pairs == 190
    assert stats.pairs - stats.static - stats.ignored == len(asked(scene))
    assert stats.in_contact == count
    assert stats.unresolved == stats.later == 0
    assert sum(stats[1:8]) == stats.pairs
    assert stats.apart_by_bounds > 0


@pytest.mark.parametrize("seed", range(10))
def test_first_is_the_first_of_all(seed: int) -> None:
    scene = random_scene(seed)

    alone = scene.first_contacts(first=True)

    assert [plain(one.body_a, one.body_b, one.contact) for one in alone] == answers(scene)[:1]
    assert alone.is_finished


def test_unresolved_pairs_come_before_the_first_contact() -> None:
    triangle = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    bodies = {
        "blob": Body(MESHES[0], motion=Motion([0, 0, 1])),
        "spinning blob": Body(
            MESHES[1], Pose(translation=[2.2, 0, 0]), Motion(None, [9, 5, 3], [2, 0, 0])
        ),
        "falling": Body(triangle, Pose(translation=[50, 0, 1]), Motion([0, 0, -2])),
        "lying": Body(triangle, Pose(translation=[50, 0, 0])),
        "waiting": Body(triangle, Pose(translation=[50, 0, -0.5])),
    }
    scene = Scene(bodies, accuracy=Accuracy(max_iterations=20))

    found = list(scene.first_contacts(first=True))

    assert [(one.body_a, one.body_b, one.status) for one in found] == [
        ("blob", "spinning blob", Status.UNRESOLVED),
        ("falling", "lying", Status.CONTACT),
    ]
    assert 0 <= found[0].time < found[1].time == 0.5


def test_named_pairs_answer_as_among_all() -> None:
    scene = random_scene(12, count=16, width=4.0)
    wanted = [(scene.bodies[i].name, scene.bodies[j].name) for i, j in asked(scene)[::3]]

    found = scene.first_contacts(pairs=[(b, a) for a, b in wanted])

    expected = [one for one in answers(scene) if (one[0], one[1]) in wanted]
    assert [plain(one.body_a, one.body_b, one.contact) for one in found] == expected
    assert found.stats.pairs == len(wanted)


@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("kind", ["default", "clearance", "coarse"])
def test_all_contacts_are_those_of_all_pairs(kind: str, seed: int) -> None:
    scene = random_scene(seed, count=8, width=5.0, accuracy=Accuracy(**KINDS[kind]))
    expected = []
    for i, j in asked(scene):
        a, b = scene.bodies[i], scene.bodies[j]
        rows = contacts(a.body, b.body, scene.duration, scene.accuracy)
        expected += [(one.time, i, j, k, a.name, b.name, one) for k, one in enumerate(rows)]
    expected.sort(key=lambda row: row[:4])

    found = list(scene.contacts())

    assert len(found) > 9
    assert [plain(one.body_a, one.body_b, one.contact) for one in found] == [
        plain(*row[4:]) for row in expected
    ]
    assert list(scene.contacts(limit=9)) == found[:9]


def test_contact_of_a_scene_tells_time_and_status() -> None:
    scene = random_scene(12, count=16, width=4.0)

    one = next(scene.first_contacts())

    assert isinstance(one, SceneContact)
    assert (one.time, one.status) == (one.contact.time, one.contact.status)


@pytest.mark.parametrize("kind", ["default", "sampled", "few steps"])
@pytest.mark.parametrize("pops", [20, 4096])
def test_threads_change_neither_answers_nor_counts(
    kind: str, pops: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(obbcli.scene.rounds, "_POPS", pops)
    scene = random_scene(4, count=14, width=4.0, accuracy=Accuracy(**KINDS[kind]))
    found = [scene.first_contacts(threads=threads) for threads in (1, 2, 5)]

    contacts = [list(each) for each in found]

    assert contacts[0] == contacts[1] == contacts[2]
    counts = [each.stats[:-2] for each in found]
    assert counts[0] == counts[1] == counts[2]
    alone = [
        first_contact(a.body, b.body, scene.duration, scene.accuracy).stats.counts
        for a, b in combinations(scene.bodies, 2)
    ]
    # Pairs that bounds tell apart are not asked about.
    assert 0 < found[0].stats.pops <= sum(each.pops for each in alone)
