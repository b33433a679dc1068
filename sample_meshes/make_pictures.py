"""Makes the README's pictures again, by the commands that stand in the README.

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


def commands(text: str) -> dict[str, list[str]]:
    """Return the words of the commands in a README that make its pictures, by the file's name."""
    shown = re.findall(r"\(sample_meshes/pictures/([\w.-]+)\)", text)
    lines = re.findall(r"^\$ (obbtree view .*)$", text, re.MULTILINE)
    made = {words[words.index("-o") + 1]: words for words in map(shlex.split, lines)}
    return {name: made[name] for name in dict.fromkeys(shown)}


def main() -> None:
    """Make all pictures."""
    FOLDER.mkdir(exist_ok=True)
    for name, words in commands((ROOT / "README.md").read_text(encoding="utf-8")).items():
        place = (FOLDER / name).relative_to(ROOT).as_posix()
        rest = [place if word == name else word for word in words[1:]]
        subprocess.run([sys.executable, "-m", "obbcli", *rest, "--force"], cwd=ROOT, check=True)


if __name__ == "__main__":
    main()
