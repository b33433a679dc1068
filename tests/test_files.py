"""Files are written whole or not at all, where and how their owner means them to be."""

from __future__ import annotations

import os
import stat
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING

import pytest

from obbcli.files import TEMPORARY, stamp_of, write_whole

if TYPE_CHECKING:
    from pathlib import Path


def test_parts_are_written_one_after_the_other(tmp_path: Path) -> None:
    write_whole(str(tmp_path / "file"), b"one, ", b"", b"two")

    assert (tmp_path / "file").read_bytes() == b"one, two"
    assert [entry.name for entry in tmp_path.iterdir()] == ["file"]


def test_longest_name_is_not_too_long(tmp_path: Path) -> None:
    path = tmp_path / ("a" * 250 + ".obbt")

    write_whole(path, b"first")
    write_whole(path, b"second")

    assert path.read_bytes() == b"second"


@pytest.mark.parametrize("exists", [False, True])
def test_link_stays_and_what_it_points_to_is_written(exists: bool, tmp_path: Path) -> None:
    (tmp_path / "trees").mkdir()
    (tmp_path / "links").mkdir()
    target, link = tmp_path / "trees" / "tree.obbt", tmp_path / "links" / "latest.obbt"
    if exists:
        target.write_bytes(b"old")
    link.symlink_to("../trees/tree.obbt")

    write_whole(link, b"new")

    assert link.is_symlink()
    assert not target.is_symlink()
    assert target.read_bytes() == b"new"
    assert len(list(tmp_path.rglob("*"))) == 4


def test_links_in_a_circle_are_refused(tmp_path: Path) -> None:
    here, there = tmp_path / "here", tmp_path / "there"
    here.symlink_to(there)
    there.symlink_to(here)

    with pytest.raises(OSError, match="here"):
        write_whole(here, b"new")

    assert here.is_symlink()
    assert there.is_symlink()


@pytest.mark.parametrize("mode", [0o600, 0o640, 0o664, 0o444])
def test_file_that_is_replaced_hands_its_mode_on(mode: int, tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_bytes(b"old")
    path.chmod(mode)

    write_whole(path, b"new")

    assert path.read_bytes() == b"new"
    assert stat.S_IMODE(path.stat().st_mode) == mode


def test_pipe_is_written_to_and_stays_a_pipe(tmp_path: Path) -> None:
    path = tmp_path / "pipe"
    os.mkfifo(path)

    with ThreadPoolExecutor(1) as pool:
        read = pool.submit(path.read_bytes)
        write_whole(path, b"through")

    assert stat.S_ISFIFO(path.stat().st_mode)
    assert read.result() == b"through"
    assert [entry.name for entry in tmp_path.iterdir()] == ["pipe"]


@pytest.mark.parametrize("exists", [False, True])
def test_what_is_not_yet_whole_is_known_by_its_name_and_private_where_its_target_is(
    exists: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "file"
    if exists:
        path.touch(mode=0o600)
    seen = []

    def look(_: int) -> None:
        seen.extend((entry.name, entry.stat().st_mode) for entry in tmp_path.iterdir())

    monkeypatch.setattr(os, "fsync", look)
    write_whole(path, b"new")

    (mode,) = [mode for name, mode in seen if name.startswith(TEMPORARY)]
    assert stat.S_IMODE(mode) & 0o077 == (
        0 if exists else stat.S_IMODE(path.stat().st_mode) & 0o077
    )


def test_interruption_right_after_the_file_was_made_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = os.open

    def interrupted(*arguments: object) -> int:
        made(*arguments)  # type: ignore[arg-type]
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "open", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_whole(tmp_path / "file", b"new")

    assert list(tmp_path.iterdir()) == []


def test_stamp_tells_files_apart(tmp_path: Path) -> None:
    path = tmp_path / "file"
    assert stamp_of(path) is None
    path.write_bytes(b"one")
    os.utime(path, ns=(0, 5))
    first = stamp_of(path)
    assert stamp_of(path) == first

    os.utime(path, ns=(0, 6))
    assert stamp_of(path) != first
    os.utime(path, ns=(0, 5))
    path.rename(tmp_path / "kept")
    path.write_bytes(b"one")
    os.utime(path, ns=(0, 5))
    assert stamp_of(path) != first


@pytest.mark.parametrize("place", ["missing/file", "folder", "file/below"])
def test_place_that_cannot_be_written_is_named_as_it_was_given(place: str, tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").write_bytes(b"old")
    path = tmp_path / place

    with pytest.raises(OSError, match=r"No such file|Is a directory|Not a directory") as refused:
        write_whole(path, b"new")

    assert (refused.value.filename, refused.value.filename2) == (str(path), None)
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["file", "folder"]
    assert (tmp_path / "file").read_bytes() == b"old"
