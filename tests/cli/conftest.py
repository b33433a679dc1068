"""Runs the command line in process, in a folder with a few cubes."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import pytest
from cube_files import cube, obj, stl

from obbcli.cli import main

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


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
    """Return what runs a command line in this process."""

    def run(*words: object) -> Ended:
        code = main([str(word) for word in words])
        streams = capsys.readouterr()
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
