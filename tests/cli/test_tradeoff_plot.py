"""`obbtree tradeoff --plot`: whole pictures, and matplotlib for them alone."""

from __future__ import annotations

import builtins
import importlib.util
import struct
from xml.etree import ElementTree

import pytest
from scenes.turning_cubes import TURN, asked


@pytest.mark.needs("matplotlib")
@pytest.mark.usefixtures("small")
@pytest.mark.parametrize(
    "words",
    [
        TURN,
        (*TURN, "--method", "sampled", "--steps", 1),
        ("--vel", 0, 0, 0),
        ("--translate-b", 1, 0, 0, "--vel", 1, 0, 0),
    ],
)
def test_plot_is_a_whole_picture(here, obbtree, words):
    for name in ("trade.svg", "trade.png"):
        ended = obbtree("tradeoff", "cube.stl", "touching.obj", *words, "--budget", 1000,
                        "--plot", name, "--quiet")  # fmt: skip
        assert ended.code == 0
    assert len(list(ElementTree.parse(here / "trade.svg").iter())) > 100
    png = (here / "trade.png").read_bytes()
    assert png.startswith(b"\x89PNG")
    width, height = struct.unpack(">II", png[16:24])
    assert width > 1000
    assert height > 600
    assert png.endswith(b"IEND\xaeB`\x82")


def test_plot_without_matplotlib_says_what_to_install(here, obbtree, monkeypatch):
    whole = importlib.util.find_spec
    monkeypatch.setattr(
        "obbcli.cli.plot.find_spec",
        lambda name: None if name == "matplotlib" else whole(name),
    )

    ended = asked(obbtree, "--plot", "trade.svg")

    assert ended.code == 2
    assert "pip install matplotlib" in ended.err
    assert ended.out == ""


def test_matplotlib_is_imported_only_where_it_is_asked_for(here, obbtree, monkeypatch, small):
    whole = builtins.__import__

    def refusing(name, *args, **kwargs):
        assert not name.startswith("matplotlib")
        return whole(name, *args, **kwargs)

    monkeypatch.setattr(builtins, "__import__", refusing)

    assert asked(obbtree, "--quiet").code == 0
