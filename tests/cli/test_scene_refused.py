"""`obbtree scene`: what it refuses, of its options and of its files."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest
from scenes.cubes import SCENE

from obbcli import ObbTree

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from conftest import Ended

    Run = Callable[..., Ended]


def test_pairs_limit_the_files_that_are_read(obbtree: Run, scene: Path) -> None:
    (scene / "far.stl").unlink()

    assert obbtree("scene", "cell.toml", "--pairs", "slow,still", "-q").code == 0
    ended = obbtree("scene", "cell.toml")
    assert ended.code == 3
    assert ended.err == "error: far.stl: no such file; check the path\n"


@pytest.mark.parametrize(
    ("pairs", "message"),
    [
        ("still", "--pairs still: names no two bodies; write --pairs A,B"),
        ("still,slo", "no body of the scene is called 'slo'; did you mean 'slow'?"),
        ("still,still", "is no pair"),
        ("a,b,c", "--pairs a,b,c: can be read in several ways"),
    ],
)
@pytest.mark.usefixtures("scene")
def test_pairs_that_are_none_are_usage_errors(pairs: str, message: str, obbtree: Run) -> None:
    ended = obbtree("scene", "cell.toml", "--pairs", pairs)

    assert ended.code == 2
    assert message in ended.err


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--first", "--limit", "2"), "--limit: lists contacts, and --first asks for one"),
        (("--first", "--all-contacts"), "--all-contacts: lists contacts, and --first asks for one"),
        (("--all-contacts", "--method", "sampled"), "sampling finds the first contact alone"),
        (("--steps", "9"), "--steps: has a meaning with --method sampled alone"),
        (("--limit", "0"), "'0' is not a whole number of at least 1"),
        (("--duration", "-1"), "'-1' is not a finite number of at least 0"),
    ],
)
@pytest.mark.usefixtures("scene")
def test_options_that_contradict_are_refused(
    options: tuple[str, ...], message: str, obbtree: Run
) -> None:
    ended = obbtree("scene", "cell.toml", *options)

    assert ended.code == 2
    assert message in ended.err


def test_output_spares_the_inputs(obbtree: Run, scene: Path) -> None:
    for name in ("cell.toml", "far.stl"):
        ended = obbtree("scene", "cell.toml", "-o", name)
        assert ended.code == 2
        assert f"is the input {name}, which would be lost" in ended.err
    assert obbtree("scene", "cell.toml", "-o", "answer.json", "--json").out == ""
    assert json.loads((scene / "answer.json").read_text())["result"]["time"] == 2


@pytest.mark.usefixtures("scene")
def test_faults_of_the_file_are_input_errors(obbtree: Run, here: Path) -> None:
    (here / "bad.toml").write_text(SCENE.replace("mesh", "mash"))
    (here / "text.toml").write_text(SCENE + "\n=")

    ended = obbtree("scene", "bad.toml")
    assert ended.code == 3
    assert ended.err == (
        "error: bad.toml: body[0] 'still': unknown key 'mash'; did you mean 'mesh'?\n"
    )
    assert obbtree("scene", "text.toml").err.startswith("error: text.toml:17: is no TOML: ")
    assert obbtree("scene", "lost.toml", "--json").error["kind"] == "SceneError"


def test_tree_files_can_be_taken_unverified(obbtree: Run, scene: Path) -> None:
    ObbTree.build(scene / "cube.stl").save(scene / "cube.obbt")
    data = bytearray((scene / "cube.obbt").read_bytes())
    data[-1] ^= 1  # what pads the last section
    (scene / "cube.obbt").write_bytes(data)
    (scene / "cell.toml").write_text(SCENE.replace("cube.stl", "cube.obbt"))

    assert obbtree("scene", "cell.toml").code == 3
    assert obbtree("scene", "cell.toml", "--no-verify").code == 0
