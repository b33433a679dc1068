"""Console blocks: their commands, and what varies of what they print from run to run."""

from __future__ import annotations

import os
import re
import subprocess
import sysconfig
from typing import TYPE_CHECKING, NamedTuple

from manual.pages import TOOLS

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

ANY_LINES = "..."
# A time, or the number of tests that an answer took, or of the boxes made for it.
VARYING = re.compile(
    # What something took, and not at what time of the motion (`t = 0.5 s`) it is.
    r"(?<!t = )(?<![\d.])\b\d+(\.\d+)?(e-\d+)? (us|ms|s)\b|(?<=box tests )[\d,]+"
    r"|(?<=triangle tests )[\d,]+( \(\S+ in exact)?"
    r"|(?<=cells )[\d,]+ \([\d,]+ points, [\d,]+ rays\)"
    r"|(?:(?<=boxes built )|(?<=of A, ))[\d,]+(?= of)"
)


class Step(NamedTuple):
    """A command line of a console block and what it should print."""

    command: str
    expected: tuple[str, ...]


def steps(block: str) -> Iterator[Step]:
    """Yield the commands of a console block; lines that begin with `> ` continue one."""
    for part in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
        first, *rest = part.splitlines()
        more = 0
        while more < len(rest) and rest[more].startswith("> "):
            more += 1
        command = "\n".join([first, *(line[2:] for line in rest[:more])])
        yield Step(command, tuple(rest[more:]))


def normalised(line: str) -> str:
    """Return a line without what may vary: columns are as wide as the times in them."""
    return VARYING.sub("#", " ".join(re.sub("─+", "─", line).split()))


def matches(expected: list[str], found: list[str]) -> bool:
    """Return whether lines are as expected, dots standing for any lines."""
    pattern = "".join(
        "(?:.*\n)*" if line == ANY_LINES else re.escape(line) + "\n" for line in expected
    )
    return re.fullmatch(pattern, "".join(line + "\n" for line in found)) is not None


def run(command: str, folder: Path) -> list[str]:
    """Return what a command line prints to a terminal's two streams."""
    # The last has a jq for machines without one.
    path = os.pathsep.join((sysconfig.get_path("scripts"), os.environ["PATH"], str(TOOLS)))
    ended = subprocess.run(
        ["sh", "-c", command],
        cwd=folder,
        env=os.environ | {"PATH": path, "LC_ALL": "C.UTF-8"},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        encoding="utf-8",
        check=False,
    )
    return ended.stdout.rstrip("\n").splitlines()
