"""Files that change while a command uses them: cut short, overwritten, replaced or removed.

The command is stopped at a call that a seed draws, the file is changed, and it goes on. It must
tell the truth about what it says it read, or end with 3 and one line; never with a signal.
"""

from __future__ import annotations

import json
import os
import random
import signal
import tempfile
from contextlib import contextmanager
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from faults.world import NEVER, Ended, calls_of, fill, finish, start, told_in_one_line
from mesh_files.cube_files import CUBE_FACES, cube, stl

from obbcli import Mesh, ObbTree, load_mesh

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping


def _halve(path: Path) -> None:
    os.truncate(path, path.stat().st_size // 2)


def _empty(path: Path) -> None:
    os.truncate(path, 0)


def _overwrite(path: Path) -> None:
    """Change every byte but the first, in place."""
    data = path.read_bytes()
    with path.open("r+b") as file:
        file.seek(1)
        file.write(bytes(byte ^ 0x55 for byte in data[1:]))


def _replace(path: Path) -> None:
    """Put a cube of the same kind in its place."""
    other = path.with_name("other" + path.suffix)
    if path.suffix == ".obbt":
        ObbTree.build(Mesh(cube(), CUBE_FACES)).save(other)
    else:
        other.write_bytes(stl(cube()))
    other.replace(path)


CHANGES = {
    "cut in half": _halve,
    "emptied": _empty,
    "overwritten": _overwrite,
    "replaced": _replace,
    "removed": Path.unlink,
}
KINDS = ("gear.stl", "gear.obbt")


class Changed(NamedTuple):
    """What a change did.

    Attributes:
        change: which.
        words: the command.
        moment: when.
        kind: `answered` or `refused`.
        ended: how the command ended.
        fault: what was not as it should be; empty where all was.
    """

    change: str
    words: tuple[str, ...]
    moment: str
    kind: str
    ended: Ended
    fault: str


def changed(count: int, seed: int) -> Iterator[Changed]:
    """Change a file that is in use, so many times.

    Args:
        count: how often.
        seed: of the moments.
    """
    rng = random.Random(seed)  # moments, not secrets
    lengths: dict[str, int] = {}
    for number in range(count):
        name = KINDS[number % len(KINDS)]
        change = list(CHANGES)[number // len(KINDS) % len(CHANGES)]
        with _world() as folder:
            if name not in lengths:
                lengths[name] = _length(folder, name)
            # What comes first are imports.
            moment = rng.randrange(lengths[name] // 2, lengths[name])
            yield _change(folder / name, change, moment)


def removed_at_both_ends() -> Iterator[Changed]:
    """Remove each file before anything is read, and when all is."""
    for name in KINDS:
        with _world() as folder:
            length = _length(folder, name)
            yield _change(folder / name, "removed", 1)
        with _world() as folder:
            yield _change(folder / name, "removed", length)


@contextmanager
def _world() -> Iterator[Path]:
    """Give a folder with the files of `fill` and the tree of the gear."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "world"
        folder.mkdir()
        fill(folder)
        ObbTree.build(load_mesh(folder / "gear.stl")).save(folder / "gear.obbt")
        yield folder


def _words(name: str) -> tuple[str, ...]:
    return ("collide", name, "pinion.stl", "--rotate", "0", "0", "0.003", "--json")


def _length(folder: Path, name: str) -> int:
    """Return how many calls the command makes that reads a file."""
    return calls_of(lambda: finish(folder, start(folder, _words(name), fault=NEVER)))


def _change(path: Path, change: str, call: int) -> Changed:
    """Change a file while a command is stopped at a call."""
    words, moment = _words(path.name), f"SIGSTOP@{call}"
    truth = {_digest(path): (11_520, "overlap_at_start")}
    process = start(path.parent, words, fault=moment)
    state = os.waitid(os.P_PID, process.pid, os.WSTOPPED | os.WEXITED | os.WNOWAIT)
    is_stopped = state is not None and state.si_code == os.CLD_STOPPED
    if is_stopped:
        CHANGES[change](path)
        if change == "replaced":
            truth[_digest(path)] = (12, "separated")
        process.send_signal(signal.SIGCONT)
    ended = finish(path.parent, process)
    kind = {0: "answered", 3: "refused"}.get(ended.code, f"exit code {ended.code}")
    return Changed(change, words, moment, kind, ended, _fault_of(ended, truth))


def _digest(path: Path) -> str:
    return sha256(path.read_bytes()).hexdigest()


def _fault_of(ended: Ended, truth: Mapping[str, tuple[int, str]]) -> str:
    """Return what is wrong: an answer must be that of the file whose digest it gives."""
    if ended.code not in (0, 3) or not told_in_one_line(ended):
        return f"exit code {ended.code}: {ended.err[-600:]!r}"
    if ended.code == 3:
        return ""
    document = json.loads(ended.out)
    about = document["inputs"]["a"]
    told = (about["triangle_count"], document["result"]["status"])
    if truth.get(about["sha256"]) == told:
        return ""
    return f"the answer {told} is not that of the file with the SHA-256 it gives"
