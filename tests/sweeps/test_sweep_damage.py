"""Damage to a tree file ends a sweep where a question reaches it, and spoils no answer before."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import numpy as np
import pytest
from tree_files.opened import data_blocks, flip, save_sheet

from obbcli import Body, ObbTree, Pose, TreeFileError, sweep
from obbcli.cli import main

if TYPE_CHECKING:
    from pathlib import Path

FAR = (1000.0, 0.0, 0.0)


@pytest.fixture
def damaged(tmp_path: Path) -> Path:
    """A tree file whose last boxes are spoilt: a question that comes near finds out."""
    path = save_sheet(tmp_path / "sheet.obbt")
    for start in data_blocks(path)[1:]:
        flip(path, start)
    return path


@pytest.mark.parametrize("threads", [1, 4])
def test_damage_that_a_row_reaches_is_told_by_its_file(damaged, threads):
    tree = ObbTree.open(damaged)
    motions = np.tile([-2000.0, 0, 0, 0, 0, 1], (50, 1))

    with pytest.raises(TreeFileError, match="is damaged between bytes") as told:
        sweep(tree, Body(tree, Pose(None, FAR)), None, motions, threads=threads)
    assert told.value.where == str(damaged)


def test_rows_before_the_damage_was_met_are_kept(damaged, capsys):
    queries, results = damaged.with_name("q.csv"), damaged.with_name("out.jsonl")
    rows = 200 * ["0 0 0"] + ["-2000 0 0"]
    queries.write_text("\n".join(["vel_b", *rows, ""]))
    place = ("--translate-b", *map(str, FAR))

    code = main(["sweep", str(damaged), str(damaged), str(queries), "-o", str(results), *place])

    kept = [json.loads(line) for line in results.read_text().splitlines()[1:]]
    assert code == 3
    assert f"error: {damaged}: is damaged between bytes" in capsys.readouterr().err
    assert {row["status"] for row in kept} == {"separated"}
    assert 1 < len(kept) <= 200
