"""Two pieces of work at the same time: what they return, and whose error counts."""

from __future__ import annotations

import shutil
from pathlib import Path
from threading import Event, current_thread

import pytest

import obbcli.files
import obbcli.threads
from obbcli import MeshError, collide
from obbcli.threads import both

SAMPLES = Path(__file__).parents[2] / "sample_meshes"


@pytest.fixture(autouse=True)
def two_cores(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let two pieces of work be done at once wherever the tests run."""
    monkeypatch.setattr(obbcli.threads, "usable_cores", lambda: 2)


def test_both_run_at_the_same_time() -> None:
    begun = Event()

    def first() -> str:
        assert begun.wait(60)
        return current_thread().name

    def second() -> str:
        begun.set()
        return current_thread().name

    here, there = both(first, second, at_once=True)

    assert here == current_thread().name != there


def test_they_run_in_turn_where_that_pays() -> None:
    calls: list[str] = []

    both(lambda: calls.append("first"), lambda: calls.append("second"), at_once=False)

    assert calls == ["first", "second"]


@pytest.mark.parametrize("at_once", [True, False])
def test_error_of_the_first_counts(at_once: bool) -> None:
    def failing(text: str) -> None:
        raise ValueError(text)

    with pytest.raises(ValueError, match="first"):
        both(lambda: failing("first"), lambda: failing("second"), at_once=at_once)
    with pytest.raises(ValueError, match="second"):
        both(lambda: None, lambda: failing("second"), at_once=at_once)


def test_interrupt_waits_for_the_second() -> None:
    ended = Event()

    def interrupted() -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        both(interrupted, ended.set, at_once=True)

    assert ended.is_set()


def test_files_read_at_once_are_the_question_they_are_in_turn(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    gear, pinion = SAMPLES / "gear.stl", SAMPLES / "pinion.stl"
    in_turn = collide(gear, pinion)
    monkeypatch.setattr(obbcli.files, "_LARGE", 0)

    at_once = collide(gear, pinion)

    assert (at_once.status, at_once.witness) == (in_turn.status, in_turn.witness)
    assert at_once.stats[:4] == in_turn.stats[:4]
    assert at_once.stats[4:8] == in_turn.stats[4:8]
    shutil.copy(gear, tmp_path / "cut.stl")
    with (tmp_path / "cut.stl").open("r+b") as file:
        file.truncate(1000)
    for pair in ((tmp_path / "cut.stl", pinion), (pinion, tmp_path / "cut.stl")):
        with pytest.raises(MeshError, match=r"cut\.stl"):
            collide(*pair)
