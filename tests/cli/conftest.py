"""Runs the command line in process, in a folder with a few cubes."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from claims.schemas import require_valid, require_valid_lines
from mesh_files.cube_files import cube, obj, stl
from scenes.cubes import SCENE

from obbcli.cli import main
from obbcli.study.tradeoff import measuring

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


SWEEP = ("sweep", "cube.stl", "apart.obj", "q.csv", "--duration", "2")


@dataclass(frozen=True)
class Ended:
    """How a command ended."""

    code: int
    out: str
    err: str

    @property
    def json(self) -> Any:
        """The one document on standard output."""
        return json.loads(self.out)

    @property
    def error(self) -> Any:
        """The one error object on standard error."""
        return json.loads(self.err)


@pytest.fixture
def obbtree(capsys: pytest.CaptureFixture[str]) -> Callable[..., Ended]:
    """Return what runs a command line in this process, and holds documents against schemas."""

    def run(*words: object) -> Ended:
        code = main([str(word) for word in words])
        streams = capsys.readouterr()
        if "--json" in words and "schema" not in words and streams.out:
            require_valid(json.loads(streams.out))
        if "--json" in words:
            for line in streams.err.splitlines():
                if line.startswith("{"):
                    require_valid(json.loads(line), "error")
        return Ended(code, streams.out, streams.err)

    return run


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Work in a folder with a cube, one that touches it, and one that does not."""
    (tmp_path / "cube.stl").write_bytes(stl(cube()))
    (tmp_path / "touching.obj").write_text(obj(cube((1, 0, 0))))
    (tmp_path / "apart.obj").write_text(obj(cube((1 + 2**-40, 0, 0))))
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def scene(here: Path) -> Path:
    """Work in a folder with a scene: unit cubes, of which one hits another at t = 2."""
    (here / "far.stl").write_bytes(stl(cube()))
    (here / "cell.toml").write_text(SCENE)
    return here


@pytest.fixture
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let `tradeoff` measure a few settings alone, by a clock that counts tests.

    Those come first that cost least. What is fastest, and so what a document shows, then depends on
    the question alone.
    """
    whole = measuring.plan

    def first(*args: Any, **kwargs: Any) -> list[Any]:
        return [one for k, one in enumerate(whole(*args, **kwargs)) if k % 3 == 0][:10]

    monkeypatch.setattr(measuring, "plan", first)
    monkeypatch.setattr(measuring, "_EARLY_ROUNDS", 1)
    monkeypatch.setattr(measuring, "_ROUNDS", 2)
    timed = measuring.Study._timed

    def counted(self: Any, *args: Any) -> tuple[Any, float]:
        answer, _seconds = timed(self, *args)
        stats = answer.stats
        return answer, 1e-7 * (1 + stats.box_tests + stats.triangle_tests + stats.pops)

    monkeypatch.setattr(measuring.Study, "_timed", counted)


def swept(path: Path) -> list[Any]:
    """Return the rows of a results file."""
    require_valid_lines(path.read_text())
    header, *rows = [json.loads(line) for line in path.read_text().splitlines()]
    assert header["schema"] == "obbtree/sweep/1"
    assert [row["row"] for row in rows] == list(range(len(rows)))
    return rows


@pytest.fixture
def ask_rows(here: Path, obbtree: Callable[..., Ended]) -> Callable[..., Any]:
    """Return what sweeps the rows of a text and gives how that ended, and the results."""

    def run(text: str | bytes, *words: object, name: str = "q.csv") -> Any:
        (here / name).write_bytes(text.encode() if isinstance(text, str) else text)
        ended = obbtree("sweep", "cube.stl", "apart.obj", name, "-o", "out.jsonl", *words)
        path = here / "out.jsonl"
        return ended, swept(path) if path.exists() else None

    return run


@pytest.fixture
def asked(here: Path, obbtree: Callable[..., Ended]) -> bytes:
    """Write questions, some of them bad, and return the results of a sweep that nothing stopped."""
    velocities = np.random.default_rng(5).normal((1, 0, 0), size=(300, 3))
    rows = [f"{k},{' '.join(map(repr, v))}" for k, v in enumerate(velocities.tolist())]
    rows[40] = "40,nowhere"
    (here / "q.csv").write_text("\n".join(["id,vel", *rows, ""]))
    ended = obbtree(*SWEEP, "-o", "whole.jsonl")
    assert ended.code == 3
    return (here / "whole.jsonl").read_bytes()
