"""Faults that need the right to mount: a small disk that fills up, a disk that takes no writes.

Each is mounted for the command alone, in a namespace of its own, and looked at before that ends.
"""

from __future__ import annotations

import subprocess
from typing import TYPE_CHECKING

from faults.scenarios import Scenario, ask, sweep

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

# 98 and 99 are no exit codes of a command: what it left is not what was there.
_AROUND = """exec unshare -m sh -c '
{mount} || exit 97
"$@"; code=$?
cmp -s old.obbt disk/old.obbt || exit 99
test "$(ls -A disk)" = "{left}" || exit 98
exit $code' sh "$@" """
_FULL = "mount -t tmpfs -o size=64k none disk && cp old.obbt disk"
_READ_ONLY = "mount --bind disk disk && mount -o remount,bind,ro disk"


def can_mount() -> bool:
    """Return whether this process may mount in a namespace of its own."""
    words = ["unshare", "-m", "mount", "-t", "tmpfs", "none", "/mnt"]
    try:
        return subprocess.run(words, capture_output=True, check=False).returncode == 0
    except FileNotFoundError:
        return False


def _make(folder: Path) -> None:
    (folder / "disk").mkdir()
    (folder / "disk" / "old.obbt").write_bytes((folder / "old.obbt").read_bytes())


def _on_disk(fault: str, words: tuple[str, ...], says: str, shell: str) -> Scenario:
    return Scenario(fault, words, 5, says, shell, prepare=_make)


def mounted() -> Iterator[Scenario]:
    """Yield commands on disks that are full or read-only."""
    tree = ("build", "gear.stl", "-o", "disk/old.obbt", "--force")
    answer = ask("--json", "-o", "disk/new.json")
    rows = sweep("q.csv", "-o", "disk/out.jsonl")
    full = _AROUND.format(mount=_FULL, left="old.obbt")
    yield _on_disk("full disk", tree, "No space left on device", full)
    # Results of a sweep grow line by line: what was answered stays.
    swept = _AROUND.format(mount=_FULL, left="old.obbt\nout.jsonl")
    yield _on_disk("full disk", rows, "No space left on device", swept)
    sealed = _AROUND.format(mount=_READ_ONLY, left="old.obbt")
    for words in (tree, answer, rows):
        yield _on_disk("read-only disk", words, "Read-only file system", sealed)
