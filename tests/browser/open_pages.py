"""Opens the pages that `obbtree view` writes in a headless Chromium, cut off from any network.

A page must log nothing, and what it shows must hold both bodies. Apart from the tests, since a
browser is no Python package: run it by `make browser`; `CHROMIUM=...` names the browser.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image

SAMPLES = Path(__file__).resolve().parents[2] / "sample_meshes"
NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")
# No display, no graphics card, no network: whatever is looked up is not found.
FLAGS = (
    *("--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"),
    *("--host-resolver-rules=MAP * ~NOTFOUND", "--enable-logging=stderr", "--window-size=960,720"),
    *("--virtual-time-budget=10000", "--hide-scrollbars"),
)
PAGES = {
    "contact": ("gear.stl", "pinion.stl", "--omega", "0 0 3", "--omega-b", "0 0 -5.9"),
    "links": ("chain_link_a.off", "chain_link_b.ply", "--vel-b", "1 0 0", "--duration", "5"),
    "boxes": ("robot_link.ply", "--level", "5"),
}


def main() -> None:
    """Open every page; end with what was seen."""
    named = os.environ.get("CHROMIUM")
    browser = named or next(filter(None, map(shutil.which, NAMES)), None)
    if browser is None:
        sys.exit("there is no Chromium: install one, or name it, as in CHROMIUM=/path/to/chrome")
    with tempfile.TemporaryDirectory() as folder:
        for name, words in PAGES.items():
            page = Path(folder) / f"{name}.html"
            make(page, words)
            logged, pixels = opened(browser, page)
            check(name, words, logged, pixels)


def make(page: Path, words: tuple[str, ...]) -> None:
    """Write a page."""
    rest = [part for word in words for part in word.split()]
    files = [str(SAMPLES / word) if (SAMPLES / word).is_file() else word for word in rest]
    command = [sys.executable, "-m", "obbcli", "view", *files, "-o", str(page), "--quiet"]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


def opened(browser: str, page: Path) -> tuple[list[str], np.ndarray]:
    """Return what a page logged, and the pixels of its screenshot, 0 to 255."""
    picture = page.with_suffix(".png")
    command = [browser, *FLAGS, f"--user-data-dir={page.with_suffix('')}"]
    ended = subprocess.run(
        [*command, f"--screenshot={picture}", page.as_uri()],
        capture_output=True,
        text=True,
        check=True,
        timeout=300,
    )
    logged = [line for line in ended.stderr.splitlines() if "CONSOLE" in line]
    with Image.open(picture) as shown:
        return logged, np.asarray(shown.convert("RGB")).astype(int)


def check(name: str, words: tuple[str, ...], logged: list[str], pixels: np.ndarray) -> None:
    """Fail unless a page logged nothing and shows what it should."""
    red, green, blue = pixels.reshape(-1, 3).T
    counts: dict[str, int] = {
        "blue": int(((blue > red + 50) & (blue > green + 20)).sum()),
        "orange": int(((red > blue + 60) & (red > green + 20)).sum()),
        "dark": int((pixels.max(axis=2) < 120).sum()),
    }
    print(f"{name}: {len(logged)} messages, pixels {counts}")
    wanted = ("blue", "orange") if words[1].partition(".")[2] in {"stl", "ply"} else ("dark",)
    if logged or any(counts[color] < 3000 // (1 + (color == "dark")) for color in wanted):
        sys.exit("\n".join([f"{name}: is not what it should be", *logged]))


if __name__ == "__main__":
    main()
