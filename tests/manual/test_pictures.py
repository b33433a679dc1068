"""The pictures shown are small, show what they should, and have a command that makes each."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from claims.png_files import pixels_of
from manual.pages import PAGES, ROOT, links

SAMPLES = ROOT / "sample_meshes"
SHOWN = {
    ((ROOT / page).parent / link).resolve().relative_to(ROOT).as_posix()
    for page, text in PAGES.items()
    for link in links(text)
    if link.endswith(".png")
}
MOST_BYTES = 150_000
TWO_BODIES = {"arm.png", "gears.png"}


def test_there_are_four_pictures_and_no_others() -> None:
    kept = {path.relative_to(ROOT).as_posix() for path in (SAMPLES / "pictures").iterdir()}

    assert kept == SHOWN
    assert len(SHOWN) == 4


def test_each_picture_has_a_command_that_makes_it() -> None:
    code = "import json, sys, make_pictures; json.dump(make_pictures.commands(), sys.stdout)"
    made = subprocess.run(
        [sys.executable, "-c", code], cwd=SAMPLES, capture_output=True, text=True, check=True
    )
    shown = {f"sample_meshes/pictures/{name}" for name in json.loads(made.stdout)}

    # What the commands draw is compared where the blocks run that hold them.
    assert shown == SHOWN
    blocks = "".join(re.findall(r"^```console\n.*?^```$", "\n".join(PAGES.values()), re.S | re.M))
    assert all(f"-o {Path(link).name}" in blocks for link in SHOWN)


@pytest.mark.parametrize("link", sorted(SHOWN))
def test_picture_is_small_and_shows_something(link: str) -> None:
    data = (ROOT / link).read_bytes()

    red, green, blue = pixels_of(data).reshape(-1, 3).T

    assert len(data) < MOST_BYTES
    if Path(link).name in TWO_BODIES:
        assert np.mean((blue > red + 50) & (blue > green + 20)) > 0.05
        assert np.mean((red > blue + 60) & (red > green + 20)) > 0.05
        assert np.sum((red > 130) & (green < 60)) > 100
    else:
        assert np.mean((blue > red + 15) & (blue > green + 15)) > 0.2
        assert np.mean((red == 255) & (green == 255) & (blue == 255)) > 0.3
