"""The fuzzers' Python targets stand: their seeds and the cases found before keep every promise."""

from __future__ import annotations

import pytest
from fuzz.run import FOLDER, corpus, targets

TARGETS = targets()
IN_CPP = {"box_lanes", "first_contact", "predicates", "screw_images", "tree_file"}


@pytest.mark.parametrize("name", TARGETS)
def test_target_takes_its_seeds_and_what_was_found(name):
    target = TARGETS[name]
    seeds = target.seeds()

    for data in [*seeds, *corpus(name)]:
        target.run(data)

    assert seeds


def test_every_corpus_is_of_a_target():
    folders = {folder.name for folder in (FOLDER / "corpus").iterdir()}

    assert folders <= {*TARGETS, *IN_CPP}
