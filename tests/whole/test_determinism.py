"""The same questions asked in other ways: threads, files, checksums, folders, seeds of hashes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click
import pytest
from determinism import QUESTIONS, Bench, Way, ways

from obbcli.cli.app import app

if TYPE_CHECKING:
    from pathlib import Path

# All that a way consists of differs from the plain one, and from one to the other.
OTHER_WAYS = (
    Way(threads=7, seed=11, trees=(True, True), verify=False, elsewhere=True),
    Way(threads=2, seed=4, trees=(False, True), piped=True),
)
# Their output is no answer: a picture, a description of documents, the manual.
ANSWERING_NOTHING = {"view", "schema", "manual"}


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Bench:
    bench = Bench(tmp_path_factory.mktemp("bench"))
    bench.add_large()
    return bench


@pytest.mark.parametrize("name", [name for name in QUESTIONS if not QUESTIONS[name].is_slow])
def test_answers_are_the_same_bytes_in_whatever_way_they_are_asked_for(
    name: str, bench: Bench
) -> None:
    question = QUESTIONS[name]

    plain = bench.answer(question, Way())

    assert plain
    for way in OTHER_WAYS:
        assert bench.answer(question, way) == plain


def test_every_command_is_asked_in_many_ways() -> None:
    commands = set(app.list_commands(click.Context(app)))

    assert commands - ANSWERING_NOTHING == {each.arguments[0] for each in QUESTIONS.values()}


def test_ways_differ_in_all_that_must_not_matter() -> None:
    asked = ways(20)

    assert asked[0] == Way(threads=1, seed=0)
    assert {way.threads for way in asked} == {1, 2, 7}
    assert len({way.seed for way in asked}) == 20
    assert {(way.trees, way.verify) for way in asked} == {
        (trees, verify)
        for trees in ((False, False), (True, True), (False, True), (True, False))
        for verify in (True, False)
    }
    assert {way.piped for way in asked} == {way.elsewhere for way in asked} == {True, False}


def test_a_document_is_compared_digit_by_digit(bench: Bench, tmp_path: Path) -> None:
    scene = bench.folder / "meshes.toml"
    plain = bench.answer(QUESTIONS["scene"], Way())
    (tmp_path / "kept").write_bytes(scene.read_bytes())

    scene.write_text(scene.read_text().replace("[0.0, 0.0, 3.0]", "[0.0, 0.0, 3.0000000000000004]"))
    other = bench.answer(QUESTIONS["scene"], Way())

    scene.write_bytes((tmp_path / "kept").read_bytes())
    assert other != plain
