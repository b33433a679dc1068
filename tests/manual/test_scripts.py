"""The hook and the workflow of the manual pass, and stop what should not pass."""

from __future__ import annotations

import os
import shutil
import subprocess
import sysconfig
from typing import TYPE_CHECKING, Any

import pytest
import yaml
from manual.pages import ROOT, TOOLS, blocks

if TYPE_CHECKING:
    from pathlib import Path

BOARD = "sample_meshes/board.vtk"


def example(key: str) -> tuple[str, Any]:
    """Return the YAML block that has a key, as text and parsed."""
    texts = [block.text for block in blocks("yaml")]
    found = [(text, parsed) for text in texts if key in (parsed := yaml.safe_load(text))]
    assert len(found) == 1
    return found[0]


def run(command: str, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run a script as workflows do: it ends with its first command that fails."""
    path = os.pathsep.join((sysconfig.get_path("scripts"), str(TOOLS), os.environ["PATH"]))
    return subprocess.run(
        ["sh", "-e", "-c", command],
        cwd=folder,
        env=os.environ | {"PATH": path, "PRE_COMMIT_HOME": str(folder.parent / "hooks")},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a repository with the sample meshes in it."""
    repository = tmp_path / "repository"
    shutil.copytree(ROOT / "sample_meshes", repository / "sample_meshes")
    ended = run("git init -q && git config user.email a@b && git config user.name a", repository)
    assert ended.returncode == 0, ended.stdout
    return repository


def lower_the_board(folder: Path) -> None:
    """Move the board into the floor, as a careless change of the design might."""
    from obbcli import load_mesh

    mesh = load_mesh(folder / BOARD)
    lines = ["# vtk DataFile Version 3.0", "board", "ASCII", "DATASET UNSTRUCTURED_GRID"]
    points = [f"{x!r} {y!r} {z - 0.05!r}" for x, y, z in mesh.vertices.tolist()]
    cells = [f"3 {a} {b} {c}" for a, b, c in mesh.triangles.tolist()]
    lines += [f"POINTS {len(points)} double", *points]
    lines += [f"CELLS {len(cells)} {4 * len(cells)}", *cells]
    lines += [f"CELL_TYPES {len(cells)}", *(["5"] * len(cells))]
    (folder / BOARD).write_text("\n".join(lines) + "\n")


@pytest.mark.needs("pre-commit")
def test_the_hook_lets_pass_what_fits_and_stops_what_does_not(folder: Path) -> None:
    text, _ = example("repos")
    (folder / ".pre-commit-config.yaml").write_text(text)
    assert run("pre-commit install && git add .", folder).returncode == 0

    fits = run("git commit -m fits", folder)
    assert fits.returncode == 0, fits.stdout
    assert "keeps 0.01 mm from its housing" in fits.stdout
    assert "Passed" in fits.stdout

    lower_the_board(folder)
    hits = run("git commit -am hits", folder)
    assert hits.returncode == 1
    assert "overlap_at_start" in hits.stdout
    assert "exit code: 1" in hits.stdout


@pytest.mark.needs("pre-commit")
def test_the_hook_looks_at_its_own_files_alone(folder: Path) -> None:
    (folder / ".pre-commit-config.yaml").write_text(example("repos")[0])
    assert run("pre-commit install && git add .pre-commit-config.yaml", folder).returncode == 0
    ended = run("git commit -m other", folder)
    assert ended.returncode == 0
    assert "no files to check" in ended.stdout


def test_the_workflow_passes_and_stops_what_does_not_fit(folder: Path) -> None:
    steps = example("jobs")[1]["jobs"]["collisions"]["steps"]
    scripts = [step["run"] for step in steps if "obbtree " in step.get("run", "")]
    assert len(scripts) == 2
    for script in scripts:
        ended = run(script, folder)
        assert ended.returncode == 0, ended.stdout

    lower_the_board(folder)
    assert run(scripts[0], folder).returncode == 1
    faster = scripts[1].replace("--vel 0 -10 0", "--vel 0 -20 0")
    assert run(faster, folder).stdout == "false\n"
    assert run(faster, folder).returncode == 1
