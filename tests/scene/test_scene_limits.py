"""Limits, stops and interrupts of a scene: what is known stays, and the rest is unresolved."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from scenes.random_scenes import MESHES, random_scene

import obbcli.scene.all_contacts
import obbcli.scene.rounds
from obbcli import Accuracy, Body, Motion, Query, Scene, Status
from obbcli.scene.first_slices import FirstSlices


def test_timeout_leaves_every_pair_unresolved_from_where_it_is_known() -> None:
    scene = random_scene(1, count=12, width=4.0, accuracy=Accuracy(timeout=0.0))
    whole = random_scene(1, count=12, width=4.0)
    contacts = scene.first_contacts()

    found = list(contacts)

    assert {one.status for one in found} == {Status.UNRESOLVED}
    assert len(found) == contacts.stats.unresolved > 10
    assert contacts.stats.pops == 0
    lows = {(one.body_a, one.body_b): one.time for one in found}
    assert [one.time for one in found] == sorted(lows.values())
    assert max(lows.values()) > 0
    for one in whole.first_contacts():
        assert lows[one.body_a, one.body_b] <= one.time


def test_timeout_ends_a_list_of_contacts_where_it_is_whole() -> None:
    scene = random_scene(2, count=8, width=5.0, accuracy=Accuracy(timeout=0.0))

    found = list(scene.contacts())

    assert {one.status for one in found} == {Status.UNRESOLVED}
    assert len(found) == len(list(scene.first_contacts()))


def test_limit_of_steps_ends_a_list_of_contacts_where_it_is_whole() -> None:
    whole = list(random_scene(6, count=8, width=5.0).contacts())
    scene = random_scene(6, count=8, width=5.0, accuracy=Accuracy(max_iterations=1000))

    found = list(scene.contacts())

    ends = {(one.body_a, one.body_b): one.time for one in found if one.status == "unresolved"}
    known = [one for one in found if one.status != "unresolved"]
    assert ends
    assert known
    assert known == [one for one in whole if one.time < ends.get((one.body_a, one.body_b), np.inf)]


def test_stop_yields_what_is_known_and_the_rest_unresolved() -> None:
    scene = random_scene(12, count=16, width=4.0)
    whole = list(scene.first_contacts())
    contacts = scene.first_contacts()

    found = list(itertools.islice(contacts, 3))
    contacts.stop()
    rest = list(contacts)

    assert found == whole[:3]
    assert {(one.body_a, one.body_b) for one in whole} <= {
        (one.body_a, one.body_b) for one in [*found, *rest]
    }
    assert [one.time for one in rest] == sorted(one.time for one in rest)
    assert all(one in whole for one in rest if one.status is not Status.UNRESOLVED)
    assert contacts.is_finished


@pytest.mark.parametrize("at", [1, 2, 3, 5, 8])
@pytest.mark.parametrize("lists", [False, True])
def test_interrupt_loses_nothing(at: int, lists: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = random_scene(2, count=10, width=4.0)
    whole = list(scene.contacts() if lists else scene.first_contacts(first=True))
    contacts = scene.contacts() if lists else scene.first_contacts(first=True)
    interrupt_at(at, monkeypatch, Query, "advance")
    found = []
    with pytest.raises(KeyboardInterrupt):
        found.extend(contacts)

    found += list(contacts)

    assert found == whole


@pytest.mark.parametrize("threads", [1, 3])
@pytest.mark.parametrize("what", [(Query, "advance"), (FirstSlices, "ask")])
@pytest.mark.parametrize("at", [1, 2, 3, 4])
def test_interrupt_of_many_questions_loses_nothing(
    at: int, what: tuple[type, str], threads: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Slices are so short that most questions take several.
    monkeypatch.setattr(obbcli.scene.rounds, "_POPS", 50)
    scene = random_scene(2, count=10, width=4.0)
    whole = list(scene.first_contacts())
    contacts = scene.first_contacts(threads=threads)
    interrupt_at(at, monkeypatch, *what)
    found = []
    with pytest.raises(KeyboardInterrupt):
        found.extend(contacts)

    found += list(contacts)

    assert found == whole


def interrupt_at(at: int, monkeypatch: pytest.MonkeyPatch, owner: type, name: str) -> None:
    """Let a method be interrupted in one of its calls, when it has done its work."""
    method = getattr(owner, name)
    calls = itertools.count(1)

    def interrupted(*args: Any, **how: Any) -> Any:
        done = method(*args, **how)
        if next(calls) == at:
            raise KeyboardInterrupt
        return done

    monkeypatch.setattr(owner, name, interrupted)


def test_interrupted_list_says_up_to_when_it_is_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = Scene({"a": MESHES[0], "b": Body(MESHES[1], motion=Motion([3, 0, 0]))})
    whole = list(scene.contacts())
    search = obbcli.scene.all_contacts.search_contacts

    def interrupted(*args: Any) -> Any:
        yield from itertools.islice(search(*args), 5)
        raise KeyboardInterrupt

    monkeypatch.setattr(obbcli.scene.all_contacts, "search_contacts", interrupted)
    contacts = scene.contacts()
    found = []
    with pytest.raises(KeyboardInterrupt):
        found.extend(contacts)

    (end,) = contacts

    assert found == whole[:5] != whole
    assert (end.status, end.time) == (Status.UNRESOLVED, found[-1].time)


def test_time_says_up_to_when_all_was_yielded() -> None:
    scene = random_scene(12, count=16, width=4.0)
    contacts = scene.first_contacts()
    times = [contacts.time]

    while not contacts.is_finished:
        one = contacts.advance()
        assert one is None or one.time == times[-1]
        times.append(contacts.time)

    assert times == sorted(times)
    assert times[-1] == scene.duration
