"""Words for codes of the kernels: each code has the word that its name there says."""

from __future__ import annotations

import itertools

from obbcli import kernels
from obbcli.answers.words import EVIDENCES, FEATURES


def test_evidence_of_the_kernels_has_the_word_of_its_name():
    words = [word or "none" for word in EVIDENCES]

    assert [one.name.lower() for one in kernels.Evidence] == words[: len(kernels.Evidence)]
    assert words[len(kernels.Evidence) :] == ["sampled"]


def test_features_are_told_by_the_dimensions_of_both_and_boxes_come_last():
    pairs = itertools.product(("vertex", "edge", "face"), repeat=2)

    assert (None, *(f"{a}-{b}" for a, b in pairs), "box") == FEATURES
