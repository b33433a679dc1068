"""Fuzz whatever reads bytes: `python tests/fuzz/run.py [--runs N | --seconds S] [TARGET...]`.

Each target is given its seeds, the cases found before (`corpus/TARGET`) and mutations of both, in
bounded memory and time; the input that breaks a promise is kept in `--found`. With `--atheris`
(`pip install atheris`) code coverage guides one target, and what it keeps goes to `--found` too.
"""

from __future__ import annotations

import argparse
import hashlib
import importlib
import pkgutil
import resource
import signal
import sys
import time
import traceback
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING, NoReturn

FOLDER = Path(__file__).parent
sys.path.insert(0, str(FOLDER.parent))

if TYPE_CHECKING:
    from fuzz.kinds import Target

#: What one input may take: CPU seconds, and bytes beyond what the process has at its start.
MOST_SECONDS = 20.0
MOST_ROOM = 3 << 30


class TooLongError(BaseException):
    """An input took too long."""


def targets() -> dict[str, Target]:
    """Return all targets by their names."""
    from fuzz import mesh_targets, part_targets, text_targets, tree_targets

    rooms = tree_targets, mesh_targets, part_targets, text_targets
    return {name: target for room in rooms for name, target in room.TARGETS.items()}


def corpus(name: str) -> list[bytes]:
    """Return the cases that were found for a target."""
    return [path.read_bytes() for path in sorted((FOLDER / "corpus" / name).glob("*"))]


def bounded(target: Target, data: bytes) -> None:
    """Run one input; whatever it raises is a finding, too long a run among it."""

    def stop(*_: object) -> NoReturn:
        raise TooLongError(f"took more than {MOST_SECONDS} CPU seconds")

    before = signal.signal(signal.SIGVTALRM, stop)
    signal.setitimer(signal.ITIMER_VIRTUAL, MOST_SECONDS)
    try:
        target.run(data)
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, before)


def mutate(name: str, target: Target, options: argparse.Namespace) -> bool:
    """Run seeds, found cases and mutations; return whether all went well."""
    from fuzz.mutations import mutated

    random = Random(f"{options.seed} {name}")
    known = [*target.seeds(), *corpus(name)]
    began = time.process_time()
    runs, slowest = 0, 0.0
    while (
        runs < len(known)
        or runs - len(known) < options.runs // target.cost
        or time.process_time() - began < options.seconds
    ):
        data = known[runs] if runs < len(known) else mutated(random, random.choice(known), known)
        start = time.process_time()
        try:
            bounded(target, data)
        except BaseException as fault:
            if isinstance(fault, KeyboardInterrupt):
                raise
            path = keep(options.found, name, data)
            traceback.print_exc()
            print(f"{name}: {type(fault).__name__} after {runs} runs; the input is {path}")
            return False
        slowest = max(slowest, time.process_time() - start)
        runs += 1
    seconds = time.process_time() - began
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss >> 10
    print(f"{name:14} {runs:8} runs {seconds:8.1f} s, slowest {slowest:5.2f} s, peak {peak} MiB")
    return True


def keep(folder: Path, name: str, data: bytes) -> Path:
    """Write an input to a file named after it."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}-{hashlib.sha256(data).hexdigest()[:12]}"
    path.write_bytes(data)
    return path


def import_all(*packages: str) -> None:
    """Import whole packages: what targets would import later would not be watched."""
    for package in packages:
        path = importlib.import_module(package).__path__
        for found in pkgutil.walk_packages(path, f"{package}."):
            if found.name != "obbcli.__main__":
                importlib.import_module(found.name)


def guided(name: str, target: Target, options: argparse.Namespace) -> None:
    """Let atheris look for inputs that reach new code; it ends the process."""
    import atheris

    import_all("obbcli", "meshio")
    # Its import hook leaves modules unwatched that come through the finder of an editable install.
    atheris.instrument_all()
    found = options.found / f"{name}.corpus"
    found.mkdir(parents=True, exist_ok=True)
    for data in [*target.seeds(), *corpus(name)]:
        keep(found, "seed", data)
    words = [
        f"-max_total_time={int(options.seconds)}",
        "-max_len=16384",
        f"-timeout={int(MOST_SECONDS)}",
        f"-rss_limit_mb={MOST_ROOM >> 20}",
        f"-artifact_prefix={options.found}/{name}-",
        "-print_final_stats=1",
    ]
    atheris.Setup([sys.argv[0], *words, str(found)], target.run)
    atheris.Fuzz()


def main() -> int:
    """Fuzz what the command line names; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("names", nargs="*", metavar="TARGET", help="all, unless named")
    parser.add_argument("--runs", type=int, default=0, help="mutations for each target")
    parser.add_argument("--seconds", type=float, default=0, help="CPU seconds for each target")
    parser.add_argument("--seed", default="0", help="of the mutations")
    parser.add_argument("--found", type=Path, default=Path(".build/fuzz/found"))
    parser.add_argument("--atheris", action="store_true", help="one target, guided by coverage")
    parser.add_argument("--list", action="store_true", help="print the names of all targets")
    options = parser.parse_args()
    options.found = options.found.absolute()
    known = targets()
    chosen = options.names or list(known)
    if options.list:
        print("\n".join(known))
        return 0
    if options.atheris:
        guided(chosen[0], known[chosen[0]], options)
    used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (used + MOST_ROOM, resource.RLIM_INFINITY))
    sound = [mutate(name, known[name], options) for name in chosen]
    return 0 if all(sound) else 1


if __name__ == "__main__":
    sys.exit(main())
