"""Makes the pictures of README and manual again, by the commands that stand there.

Run from the root of the project, as `make pictures` does; needs the installed `obbtree`.
"""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "sample_meshes" / "pictures"
PAGES = (ROOT / "README.md", *sorted((ROOT / "obbcli" / "manual").glob("*.md")))


def commands() -> dict[str, list[str]]:
    """Return the words of the commands that make the pictures shown, by the pictures' names."""
    text = "\n".join(page.read_text(encoding="utf-8") for page in PAGES)
    shown = re.findall(r"\((?:\.\./)*sample_meshes/pictures/([\w.-]+)\)", text)
    lines = re.findall(r"^\$ (obbtree view .*)$", text, re.MULTILINE)
    made = {words[words.index("-o") + 1]: words for words in map(shlex.split, lines)}
    return {name: made[name] for name in dict.fromkeys(shown)}


def main() -> None:
    """Make all pictures."""
    FOLDER.mkdir(exist_ok=True)
    for name, words in commands().items():
        place = (FOLDER / name).relative_to(ROOT).as_posix()
        rest = [place if word == name else word for word in words[1:]]
        subprocess.run([sys.executable, "-m", "obbcli", *rest, "--force"], cwd=ROOT, check=True)


if __name__ == "__main__":
    main()
