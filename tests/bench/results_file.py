"""The figures of benches, kept as data: one file a machine, in `tests/bench/results/`.

A run replaces the benches that it measured and leaves the others as they were, each with its own
date, load and command.
"""

from __future__ import annotations

import json
import os
import re
from dataclasses import asdict
from datetime import datetime, timezone
from pathlib import Path
from typing import TYPE_CHECKING, Any

from harness import Row, Timing

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

SCHEMA = "obbtree/bench-results/1"
FOLDER = Path(__file__).resolve().parent / "results"


def machine_name(about: Mapping[str, object]) -> str:
    """Return a file's name for a machine: its processor's words and the number of its cores."""
    words = re.sub(r"\(.*?\)|@.*|\bprocessor\b|\bcpu\b", " ", str(about["processor"]).lower())
    return "-".join([*re.findall(r"[a-z0-9]+", words), f"{about['cores']}-cores"])


def write(
    measured: Mapping[str, Sequence[Row]], about: Mapping[str, object], command: str, load: float
) -> Path:
    """Put what a run measured into this machine's file, and return the file.

    Args:
        measured: rows by the name of the bench, as `--only` takes it.
        about: the machine.
        command: that measured, without paths of this machine.
        load: how many processes wanted a core when the run began.
    """
    FOLDER.mkdir(exist_ok=True)
    path = FOLDER / f"{machine_name(about)}.json"
    benches: dict[str, Any] = json.loads(path.read_text())["benches"] if path.exists() else {}
    today = datetime.now(timezone.utc).date().isoformat()
    for name, rows in measured.items():
        benches[name] = {
            "measured": today,
            "command": command,
            "load": round(load, 1),
            "rows": [asdict(row) for row in rows],
        }
    whole = {"schema": SCHEMA, "machine": dict(about), "benches": dict(sorted(benches.items()))}
    fresh = path.with_suffix(f".{os.getpid()}")
    fresh.write_text(json.dumps(whole, indent=1) + "\n")
    fresh.replace(path)
    return path


def read(path: Path) -> dict[str, Any]:
    """Return a machine's file.

    Raises:
        ValueError: it is of another kind.
    """
    whole: dict[str, Any] = json.loads(path.read_text())
    if whole.get("schema") != SCHEMA:
        raise ValueError(f"{path.name}: is {whole.get('schema')!r}, wanted {SCHEMA!r}")
    return whole


def rows_of(bench: Mapping[str, Any]) -> list[Row]:
    """Return the rows of a bench as they were measured."""
    return [
        Row(
            row["bench"],
            row["case"],
            row["triangles"],
            {who: Timing(**timing) for who, timing in row["timings"].items()},
            row["notes"],
        )
        for row in bench["rows"]
    ]
