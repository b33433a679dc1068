"""Scenes, queries, results of sweeps, patterns: an answer, or an error of the contract."""

from __future__ import annotations

import contextlib
import functools
import io
import os
import tempfile
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from fuzz.kinds import Target, require
from mesh_files.cube_files import cube, stl

from obbcli import Scene
from obbcli.cli import main
from obbcli.errors import ObbError
from obbcli.mesh.parts.pattern import Pattern, escaped

if TYPE_CHECKING:
    from collections.abc import Iterator

SCENE_TOML = b"""
duration = 2.0
accuracy = { clearance = 0.25, max_iterations = 1000, timeout = 1.0 }

[[body]]
name = "lid"
mesh = "cube.stl"
pose = { rotation = [0, 0, 1.5], translation = [3, 0, 0.5] }
motion = { linear_velocity = [-1, 0, 0], angular_velocity = [0, 0, 2.5], pivot = [3, 0, 0.5] }
group = "moving"

[[body]]
name = "arm"
mesh = "cube.stl"
group = "moving"

[body.motion]
times = [0, 1.5]
poses = [{ translation = [9, 9, 9] }, { rotation = [0, 0.5, 0] }]

[[body]]
name = "box"
mesh = "cube.stl"
static = true

[[ignore]]
groups = ["moving"]
"""
SCENE_JSON = b"""{"duration": 1.5, "accuracy": {"time_tolerance": 1e-6, "max_depth_a": 3},
"body": [{"name": "a", "mesh": "cube.stl", "static": true},
 {"name": "b", "mesh": "cube.stl", "pose": {"translation": [4, 0, 0], "rotation": [0.1, 0, 0]},
  "motion": {"linear_velocity": [-3, 0, 0.5]}, "group": "g"}],
"ignore": [{"bodies": ["a", "b"]}]}"""
QUERIES_CSV = b"""id,vel,omega,pivot,translate_b,rotate_b,duration
one,"-1 0 0",0 0 1,0 0 0,3 0 0,,2
two,1 0 0,,,5 0 0,0.1 0.2 0.3,1.5
"""
QUERIES_JSONL = b"""{"id": "one", "vel": [-1, 0, 0], "translate_b": [3, 0, 0], "duration": 2}
{"id": 2, "vel": [1, 0, 0], "omega": [0, 0, 1], "pivot": [0, 0, 0], "rotate_b": [0.1, 0, 0]}
"""
_CODES = {0, 2, 3, 4, 5}


@contextlib.contextmanager
def _folder() -> Iterator[Path]:
    """Work in a new folder with a cube in it."""
    before = Path.cwd()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "cube.stl").write_bytes(stl(cube()))
        os.chdir(folder)
        try:
            yield folder
        finally:
            os.chdir(before)


def _run_scene(name: str, data: bytes) -> None:
    with _folder() as folder:
        (folder / name).write_bytes(data)
        try:
            scene = Scene.load(folder / name)
            for _ in zip(range(20), scene.first_contacts(), strict=False):
                pass
        except ObbError:
            pass


def _swept(name: str, *words: str) -> tuple[int, str]:
    told = io.StringIO()
    command = ["sweep", "cube.stl", "cube.stl", name, "-o", "r.jsonl", "--max-iterations", "2000"]
    with contextlib.redirect_stdout(told), contextlib.redirect_stderr(told):
        return main([*command, *words]), told.getvalue()


def _run_queries(name: str, data: bytes) -> None:
    with _folder() as folder:
        (folder / name).write_bytes(data)
        code, told = _swept(name, "--duration", "1")
        require(code in _CODES, f"a sweep ends as the contract says, not with {code}: {told}")


@functools.cache
def _results() -> bytes:
    with _folder() as folder:
        (folder / "q.csv").write_bytes(QUERIES_CSV)
        code, told = _swept("q.csv")
        require(code == 0, told)
        return (folder / "r.jsonl").read_bytes()


def _run_results(data: bytes) -> None:
    with _folder() as folder:
        (folder / "q.csv").write_bytes(QUERIES_CSV)
        (folder / "r.jsonl").write_bytes(data)
        code, told = _swept("q.csv", "--resume")
        require(code in _CODES, f"a sweep ends as the contract says, not with {code}: {told}")
        if code:
            require((folder / "r.jsonl").read_bytes() == data, "what is refused is left as it was")


def _run_pattern(data: bytes) -> None:
    """Match a path by a pattern, the two being lines; a path that is escaped takes itself."""
    text, _, path = data.decode("utf-8", "replace").partition("\n")
    pattern = Pattern(text)
    if pattern.takes(path):
        require(pattern.takes(f"{path}/below"), "a match takes the subtree")
        require(Pattern(f"**/{text}").takes(path), "**/ takes what is at the top as well")
    require(Pattern(escaped(path)).takes(path), "an escaped path takes itself")
    require(Pattern("**").takes(path), "** takes everything")
    require(
        Pattern(f"**/{text}").takes(path) >= pattern.takes(path), "**/ takes what is at the top"
    )


PATTERNS = [
    b"arm/**/bolt[1-3!]*\narm/left/hand/bolt2",
    b"**/**/\\*\\[?\na/b/*[x",
    b"[!a-c]/[]]/[a\\-z\nd/]/-",
    b"*a*b*c*/**/*d*\nabcabcabc/x/y/ddd#2",
]


TARGETS = {
    "part-patterns": Target(lambda: PATTERNS, _run_pattern),
    "scene-toml": Target(lambda: [SCENE_TOML], partial(_run_scene, "s.toml")),
    "scene-json": Target(lambda: [SCENE_JSON], partial(_run_scene, "s.json")),
    "queries-csv": Target(lambda: [QUERIES_CSV], partial(_run_queries, "q.csv")),
    "queries-jsonl": Target(lambda: [QUERIES_JSONL], partial(_run_queries, "q.jsonl")),
    "results": Target(lambda: [_results()], _run_results),
}
