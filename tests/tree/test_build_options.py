"""How trees are built: one list of fits and splits, and what is refused."""

from __future__ import annotations

from typing import get_args

import numpy as np
import pytest

from obbcli import MeshError, kernels
from obbcli.tree.options import DEFAULT_BUILD, FITS, SPLITS, BuildOptions, Fit, Split


@pytest.mark.parametrize(
    ("words", "told", "coded"),
    [(get_args(Fit), FITS, kernels.Fit), (get_args(Split), SPLITS, kernels.Split)],
)
def test_kernels_and_help_know_the_same_ways(words, told, coded):
    assert words == tuple(told)
    assert [word.upper().replace("-", "_") for word in words] == [one.name for one in coded]


def test_default_build_is_the_one_that_documents_name():
    assert DEFAULT_BUILD == ("triangles", "compact", 1, None)


def test_options_come_back_as_plain_numbers():
    options = BuildOptions(leaf_size=np.int32(3), max_depth=np.uint8(0)).checked()

    assert options == ("triangles", "compact", 3, 0)
    assert (type(options.leaf_size), type(options.max_depth)) == (int, int)


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"fit": "hulls"}, "fit: is 'hulls'; use one of triangles, points, hull, min-volume"),
        ({"fit": ["hull"]}, "fit: is ['hull']; use one of"),
        ({"split": None}, "split: is None; use one of median, center, compact"),
        ({"leaf_size": 0}, "leaf_size: is 0; use a whole number of at least 1"),
        ({"leaf_size": 2.0}, "leaf_size: is 2.0; use a whole number of at least 1"),
        ({"leaf_size": True}, "leaf_size: is True; use a whole number of at least 1"),
        ({"max_depth": -1}, "max_depth: is -1; use a whole number of at least 0"),
        ({"max_depth": "4"}, "max_depth: is '4'; use a whole number of at least 0"),
    ],
)
def test_what_is_none_of_them_is_refused(given, told):
    with pytest.raises(MeshError) as refusal:
        BuildOptions(**given).checked()

    assert str(refusal.value).startswith(told)
