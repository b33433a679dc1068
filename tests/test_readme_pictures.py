"""The README's pictures are what its commands make, small, and show what they should."""

from __future__ import annotations

import io
import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread

ROOT = Path(__file__).resolve().parents[1]
SAMPLES = ROOT / "sample_meshes"
TEXT = (ROOT / "README.md").read_text(encoding="utf-8")
LINKS = re.findall(r"!\[[^\]]+\]\(([^)]+)\)", TEXT)
MOST_BYTES = 150_000
TWO_BODIES = {"arm.png", "gears.png"}


def commands():
    """Return the words of the commands that make the pictures, read as `make pictures` does."""
    code = "import make_pictures, json, sys; json.dump(make_pictures.commands(open(sys.argv[1], "
    code += "encoding='utf-8').read()), sys.stdout)"
    made = subprocess.run(
        [sys.executable, "-c", code, str(ROOT / "README.md")],
        cwd=SAMPLES,
        capture_output=True,
        text=True,
        check=True,
    )
    return json.loads(made.stdout)


def pixels(data):
    """Return the pixels of a PNG file, 0 to 255."""
    return np.rint(255 * imread(io.BytesIO(data), format="png")).astype(int)


def test_there_are_four_pictures_and_no_others():
    assert sorted(LINKS) == sorted(
        path.relative_to(ROOT).as_posix() for path in (SAMPLES / "pictures").iterdir()
    )
    assert len(set(LINKS)) == 4
    assert [f"sample_meshes/pictures/{name}" for name in commands()] == LINKS


@pytest.mark.parametrize("link", LINKS)
def test_picture_is_small_and_shows_something(link):
    data = (ROOT / link).read_bytes()

    red, green, blue = pixels(data).reshape(-1, 3).T

    assert len(data) < MOST_BYTES
    if Path(link).name in TWO_BODIES:
        assert np.mean((blue > red + 50) & (blue > green + 20)) > 0.05
        assert np.mean((red > blue + 60) & (red > green + 20)) > 0.05
        assert np.sum((red > 130) & (green < 60)) > 100
    else:
        assert np.mean((blue > red + 15) & (blue > green + 15)) > 0.2
        assert np.mean((red == 255) & (green == 255) & (blue == 255)) > 0.3


@pytest.mark.parametrize("link", LINKS)
def test_command_makes_the_picture_that_is_shown(link, tmp_path):
    name = Path(link).name
    place = tmp_path / name
    words = [str(place) if word == name else word for word in commands()[name]]

    subprocess.run([sys.executable, "-m", "obbcli", *words[1:]], cwd=ROOT, check=True)

    made, shown = pixels(place.read_bytes()), pixels((ROOT / link).read_bytes())
    assert made.shape == shown.shape
    # The last bits of a processor may move an edge by a pixel.
    assert np.abs(made - shown).mean() < 0.5
