"""A folder with small files of every kind, a command run in it, and what that left there."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mesh_files.cube_files import CUBE_FACES, cube, obj, stl

from obbcli import Mesh, ObbTree
from obbcli.files import TEMPORARY

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

_LAUNCH = Path(__file__).with_name("launch.py")
_SAMPLES = Path(__file__).resolve().parents[2] / "sample_meshes"
#: A fault that counts calls and does nothing: its signal would come after all of them.
NEVER = f"SIGCONT@{1 << 60}"
_QUESTIONS = 400
# Sets of strings are walked in the same order in every run, so that runs make the same calls.
_REPEATABLE = {"PYTHONHASHSEED": "0"}
_SCENE = b"""duration = 2.0
body = [
  { name = "still", mesh = "cube.stl" },
  { name = "moving", mesh = "apart.obj", motion = { linear_velocity = [-1, 0, 0] } },
  { name = "gear", mesh = "gear.stl", pose = { translation = [0, 0, 90] } },
]
"""


@dataclass(frozen=True)
class Ended:
    """How a command ended.

    Attributes:
        code: its exit code; minus the number of the signal that ended it.
        out: what it wrote to standard output.
        err: the same of standard error.
        has_begun: whether the command line had begun.
        calls: how many calls it made, where they were counted and it came to its end.
    """

    code: int
    out: str
    err: str
    has_begun: bool
    calls: int

    @property
    def line(self) -> str:
        """The last line of standard error."""
        return (self.err.splitlines() or [""])[-1]


@cache
def _files() -> Mapping[str, bytes]:
    """Return what stands in the folder before a command runs."""
    rows = [f"{-1 - k / 7} {k / 977} 0" for k in range(_QUESTIONS)]
    return {
        "cube.stl": stl(cube()),
        "touching.obj": obj(cube((1, 0, 0))).encode(),
        "apart.obj": obj(cube((1.5, 0, 0))).encode(),
        "q.csv": "\n".join(["vel_b", *rows, ""]).encode(),
        "cell.toml": _SCENE,
        "old.obbt": _tree_file(),
        "old.json": b'{"old": true}\n',
        "gear.stl": (_SAMPLES / "gear.stl").read_bytes(),
        "pinion.stl": (_SAMPLES / "pinion.stl").read_bytes(),
    }


def _tree_file() -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "cube.obbt"
        ObbTree.build(Mesh(cube(), CUBE_FACES)).save(path)
        return path.read_bytes()


def fill(folder: Path) -> Mapping[str, bytes]:
    """Put the files into an empty folder, and return them by their names."""
    for name, data in _files().items():
        (folder / name).write_bytes(data)
    return _files()


def _as_a_terminal_would() -> None:
    """Undo what shells and test runners do to the signals of those they start."""
    signal.signal(signal.SIGINT, signal.default_int_handler)


def start(
    folder: Path,
    words: Sequence[str],
    *,
    fault: str = "",
    shell: str = "",
    limit: Callable[[], None] | None = None,
    environment: Mapping[str, str | None] | None = None,
) -> subprocess.Popen[bytes]:
    """Start a command in the folder.

    Args:
        folder: where; beside it the process notes its events.
        words: the command line.
        fault: as `launch.py` takes it.
        shell: what a shell is to do with the streams, or a whole script around `"$@"`.
        limit: called in the process before it is one of Python's.
        environment: what is other than here; None takes a variable away.
    """
    changed = {**os.environ, **_REPEATABLE, **(environment or {})}

    def prepare() -> None:
        _as_a_terminal_would()
        if limit is not None:
            limit()

    command = [sys.executable, str(_LAUNCH), str(_events(folder)), fault, *words]
    script = shell if '"$@"' in shell else f'exec "$@" {shell}'
    return subprocess.Popen(
        ["sh", "-c", script, "sh", *command] if shell else command,
        cwd=folder,
        env={name: value for name, value in changed.items() if value is not None},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        preexec_fn=prepare,  # nothing here has threads
    )


def finish(folder: Path, process: subprocess.Popen[bytes]) -> Ended:
    """Wait for a command's end."""
    out, err = process.communicate(timeout=300)
    told = _events(folder).read_text().split() if _events(folder).exists() else []
    _events(folder).unlink(missing_ok=True)
    calls = int(told[1]) if len(told) == 2 else 0
    texts = (stream.decode(errors="backslashreplace") for stream in (out, err))
    return Ended(process.returncode, *texts, bool(told), calls)


def calls_of(run: Callable[[], Ended]) -> int:
    """Return how many calls a command makes when it runs to its end.

    Args:
        run: runs it with the fault `NEVER`. It is called twice, because the first run may also
            compile modules, and later runs find them compiled.
    """
    run()
    return run().calls


def _events(folder: Path) -> Path:
    return folder.with_name(f"{folder.name}.events")


def contents(folder: Path) -> dict[str, bytes]:
    """Return the files in a folder that may be read."""
    paths = [path for path in folder.iterdir() if path.is_file() and os.access(path, os.R_OK)]
    return {path.name: path.read_bytes() for path in paths}


def damage(
    folder: Path,
    before: Mapping[str, bytes],
    *,
    written: Sequence[str] = (),
    is_killed: bool = False,
) -> str:
    """Return what is wrong with the files in the folder; empty where all are whole.

    Args:
        folder: where a command ran.
        before: what was there.
        written: names of files that it may have written, whole.
        is_killed: whether it had no chance to remove what was not yet whole.
    """
    faults = []
    after = contents(folder)
    for name, data in before.items():
        if after.get(name) != data and name not in written:
            faults.append(f"{name} is not what it was")
        elif name not in after:
            faults.append(f"{name} is gone")
    for name in after.keys() - before.keys():
        if name not in written and not (is_killed and name.startswith(TEMPORARY)):
            faults.append(f"{name} was left behind")
    for name in after.keys() & set(written):
        if after[name] != before.get(name):
            faults += _faults_of(folder / name)
    return "; ".join(faults)


def _faults_of(path: Path) -> list[str]:
    """Return what is wrong with a file that a command wrote."""
    try:
        if path.suffix == ".obbt":
            ObbTree.open(path).check()
        elif path.suffix == ".jsonl":
            _check_rows(path.read_bytes())
        elif path.suffix == ".glb":
            data = path.read_bytes()
            assert data[:4] == b"glTF"
            assert int.from_bytes(data[8:12], "little") == len(data), "it is cut short"
        elif path.suffix == ".svg":
            assert path.read_bytes().rstrip().endswith(b"</svg>")
        else:
            json.loads(path.read_bytes())
    except (ValueError, AssertionError) as fault:
        return [f"{path.name} is not whole: {fault}"]
    return []


def _check_rows(data: bytes) -> None:
    """Hold results of a sweep to be whole rows in order; the last line alone may be torn."""
    rows: list[Any] = [json.loads(line) for line in data.split(b"\n")[:-1]]
    assert [row["row"] for row in rows[1:]] == list(range(len(rows) - 1)), "rows are missing"


def told_in_one_line(ended: Ended) -> bool:
    """Return whether standard error is one line of ours, or empty."""
    return re.fullmatch(r"(error|note): .*\n|\{.*\}\n|", ended.err) is not None
