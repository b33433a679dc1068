"""Prints what to install for a job at one end of the versions allowed: `bounds.py oldest|newest`.

The oldest are the lower bounds of pyproject.toml themselves, those of the build included; the
newest are whatever the index has. Tools that only look at the code or race against us are left out.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

PROJECT = Path(__file__).resolve().parents[2] / "pyproject.toml"
EXTRAS = ("distributed", "plot", "test", "test-extras")
_REQUIREMENT = re.compile(r"([A-Za-z0-9._-]+)>=([0-9.]+)((?:\s*;.*)?)")


def requirements(project: dict[str, Any], end: str) -> list[str]:
    """Return one requirement for each dependency, exactly its bound or without one.

    Raises:
        ValueError: a dependency has no lower bound, or more than that.
    """
    extras = project["project"]["optional-dependencies"]
    wanted = [*project["build-system"]["requires"], *project["project"]["dependencies"]]
    wanted += [line for name in EXTRAS for line in extras[name]]
    found = []
    for line in dict.fromkeys(wanted):
        match = _REQUIREMENT.fullmatch(line)
        if match is None:
            raise ValueError(f"{line}: expected name>=version")
        name, bound, marker = match.groups()
        found.append(f"{name}=={bound}{marker}" if end == "oldest" else f"{name}{marker}")
    return found


def main() -> None:
    """Print the requirements, one a line."""
    project = tomllib.loads(PROJECT.read_text(encoding="utf-8"))
    sys.stdout.write("\n".join(requirements(project, sys.argv[1])) + "\n")


if __name__ == "__main__":
    main()
