"""Faults that are there before a command begins: full disks, closed streams, odd names and places.

Each says how the command must end. Folders that may not be written to are so for the superuser too,
who is run without the right to pass permissions by.
"""

from __future__ import annotations

import ctypes
import os
import resource
import socket
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from faults.signals import GEARS

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

_DROP_FROM_BOUNDING_SET = 24  # prctl
_DAC_OVERRIDE, _DAC_READ_SEARCH, _SYS_ADMIN, _SYS_RESOURCE = 1, 2, 21, 24


@dataclass(frozen=True)
class Scenario:
    """A command under a fault, and how it must end.

    Attributes:
        fault: what is wrong.
        words: the command line.
        code: the exit code.
        says: what the one line on standard error must hold, as a pattern; empty: there is none.
        shell: what a shell does with the streams, or a script around `"$@"`.
        limit: called in the process before it is one of Python's.
        environment: what is other than here; None takes a variable away.
        prepare: called with the folder.
        written: files that the command may write.
    """

    fault: str
    words: tuple[str, ...]
    code: int
    says: str = ""
    shell: str = ""
    limit: Callable[[], None] | None = None
    environment: Mapping[str, str | None] = field(default_factory=dict)
    prepare: Callable[[Path], None] | None = None
    written: tuple[str, ...] = ()


def ask(*more: str) -> tuple[str, ...]:
    """Return the words of a question that is answered at once."""
    return ("collide", "cube.stl", "apart.obj", *more)


def sweep(*more: str) -> tuple[str, ...]:
    """Return the words of a short sweep."""
    return ("sweep", "cube.stl", "apart.obj", *more)


SAVED = ("build", "gear.stl", "-o", "old.obbt", "--force")


def _limited(kind: int, most: int) -> Callable[[], None]:
    return lambda: resource.setrlimit(kind, (most, most))


def _without(*rights: int) -> None:
    """Give up rights that only the superuser has, for this process and those after it."""
    libc = ctypes.CDLL(None, use_errno=True)
    for right in rights if os.geteuid() == 0 else ():
        if libc.prctl(_DROP_FROM_BOUNDING_SET, right, 0, 0, 0) != 0:
            raise OSError(ctypes.get_errno(), "a right cannot be given up")


def _as_others() -> None:
    """Let permissions bind."""
    _without(_DAC_OVERRIDE, _DAC_READ_SEARCH)


def _threadless() -> None:
    """Let the system refuse every thread; the superuser's own are never counted."""
    _without(_SYS_ADMIN, _SYS_RESOURCE)
    if os.geteuid() == 0:
        os.setresuid(65534, 0, 0)
    resource.setrlimit(resource.RLIMIT_NPROC, (0, 0))


def full_disks() -> Iterator[Scenario]:
    """Yield disks and devices that take no more."""
    small = _limited(resource.RLIMIT_FSIZE, 100)
    fault, says = "file size limit", "cannot be written: File too large"
    yield Scenario(fault, SAVED, 5, f"old.obbt: {says}", limit=small)
    yield Scenario(fault, ask("--json", "-o", "old.json"), 5, says, limit=small)
    yield Scenario(fault, ("info", "cube.stl", "-o", "new.txt"), 5, says, limit=small)
    words = sweep("q.csv", "-o", "out.jsonl")
    yield Scenario(fault, words, 5, says, limit=small, written=("out.jsonl",))
    says = "cannot be written: No space left on device"
    for words in (ask(), ask("--json"), ("info", "gear.stl"), ("scene", "cell.toml"), ("schema",)):
        yield Scenario("stdout full", words, 5, says, ">/dev/full")
    yield Scenario("stdout full", ("--help",), 5, f"standard output.*{says}", ">/dev/full")
    yield Scenario("-o full device", ask("-o", "/dev/full"), 5, f"/dev/full.*{says}")
    yield Scenario("-o full device", sweep("q.csv", "-o", "/dev/full"), 5, f"/dev/full.*{says}")


def places() -> Iterator[Scenario]:
    """Yield places that cannot be written to or read from."""

    def seal(folder: Path) -> None:
        (folder / "sealed").mkdir(mode=0o555)

    def hide(folder: Path) -> None:
        (folder / "hidden.stl").write_bytes(b"")
        (folder / "hidden.stl").chmod(0)

    says = "cannot be written: Permission denied"
    for words in (
        ("build", "cube.stl", "-o", "sealed"),
        ask("-o", "sealed/new.json", "--json"),
        sweep("q.csv", "-o", "sealed/out.jsonl"),
    ):
        yield Scenario("read-only folder", words, 5, says, limit=_as_others, prepare=seal)
    says = "hidden.stl: .*permission denied"
    words = ("info", "hidden.stl")
    yield Scenario("unreadable file", words, 3, says, limit=_as_others, prepare=hide)
    yield Scenario("/proc", ask("-o", "/proc/new.json"), 5, "/proc/new.json: cannot be written")
    yield Scenario("no such folder", ask("-o", "gone/new.json"), 5, "create its folder first")
    for name, kind in (("--plot", "tradeoff"), ("--plot", "stability")):
        words = (kind, "cube.stl", "apart.obj", name, "gone/new.svg")
        yield Scenario("no such folder", words, 5, "its folder is not there")
    for words in (ask("-o", "."), sweep("q.csv", "-o", ".")):
        yield Scenario("-o is a folder", words, 5, "Is a directory")
    yield Scenario("exists", ("build", "cube.stl", "-o", "old.obbt"), 5, "exists already")


def inputs_as_outputs() -> Iterator[Scenario]:
    """Yield outputs that would take an input's place."""

    def link(folder: Path) -> None:
        (folder / "same.stl").symlink_to("cube.stl")
        os.link(folder / "cube.stl", folder / "hard.stl")

    for words, output in (
        (ask(), "cube.stl"),
        (ask(), "./apart.obj"),
        (ask(), "same.stl"),
        (ask(), "hard.stl"),
        (("info", "old.obbt"), "old.obbt"),
        (("build", "cube.stl", "--force"), "cube.stl"),
        (("scene", "cell.toml"), "cell.toml"),
        (("scene", "cell.toml"), "gear.stl"),
        (sweep("q.csv"), "q.csv"),
        (("distance", "cube.stl", "apart.obj"), "apart.obj"),
    ):
        name = "-o is an input"
        told = "which would be lost"
        yield Scenario(name, (*words, "-o", output), 2, told, prepare=link)


def streams() -> Iterator[Scenario]:
    """Yield streams that are closed, or not what they should be."""
    gone = ("info", "gone.stl")
    for words in (ask(), ask("--json"), ("schema",), ("--help",), ()):
        yield Scenario("stdout closed", words, 5, "is closed", ">&-")
    yield Scenario("stdout closed", ask("-o", "old.json", "--json"), 0, shell=">&-",
                   written=("old.json",))  # fmt: skip
    yield Scenario("all closed", SAVED, 5, shell="<&- >&- 2>&-", written=("old.obbt",))
    words = ask("-o", "old.json", "--json")
    yield Scenario("all closed", words, 0, shell="<&- >&- 2>&-", written=("old.json",))
    for shell in ("2>&-", "2>/dev/full"):
        yield Scenario(f"stderr {shell}", ask(), 0, shell=shell)
        yield Scenario(f"stderr {shell}", gone, 3, shell=shell)
    yield Scenario("stdin closed", ask(), 0, shell="<&-")
    for shell in ("<&-", "</dev/null", "</dev/zero"):
        for words in (("info", "-"), ("scene", "-"), sweep("-", "-o", "out.jsonl")):
            yield Scenario(f"stdin {shell}", words, 3, "<stdin>: is no file or pipe", shell)


def no_files() -> Iterator[Scenario]:
    """Yield inputs that are there, and are no files."""

    def make(folder: Path) -> None:
        (folder / "folder.stl").mkdir()
        (folder / "loop.stl").symlink_to("loop.stl")
        with socket.socket(socket.AF_UNIX) as end:
            here = Path.cwd()
            os.chdir(folder)  # names of sockets are short
            end.bind("socket.stl")
            os.chdir(here)

    for name, says in (
        ("folder.stl", "directory|folder"),
        ("loop.stl", "symbolic links"),
        ("socket.stl", "device|socket|No such device"),
        ("/dev/zero", "device|bytes or more"),
        ("gone.stl/beyond.stl", "directory|no such file"),
    ):
        for words in (
            ("info", name),
            ("collide", "cube.stl", name),
            ("build", name, "-o", "new.obbt"),
            ("scene", name),
            sweep(name, "-o", "out.jsonl"),
        ):
            yield Scenario(f"input is {name}", words, 3, f"{name}.*({says})", prepare=make)
    words = ask("-o", "loop.stl")
    yield Scenario("-o is a link to itself", words, 5, "loop.stl.*symbolic links", prepare=make)


def names() -> Iterator[Scenario]:
    """Yield names that are legal and odd, of files that are there and that are not."""
    for name in ("with space.stl", "two\nlines.stl", "-dash.stl", "\udcff\udcfe.stl", "é" * 120):

        def make(folder: Path, name: str = name) -> None:
            Path(folder, name + "!.stl").write_bytes((folder / "cube.stl").read_bytes())

        shown = ascii(name[:10])
        for environment in ({}, {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}):
            more = {"environment": environment, "prepare": make}
            yield Scenario(f"name {shown}", ("info", "--", name + "!.stl"), 0, **more)
            words = ("info", "--json", "--", name + "!.stl")
            yield Scenario(f"name {shown}", words, 0, **more)
            words = ("info", "--", name + "gone.stl")
            yield Scenario(f"name {shown}, gone", words, 3, "no such file", **more)


def environments() -> Iterator[Scenario]:
    """Yield environments that lack something."""
    for environment in (
        {"HOME": None},
        {"HOME": "/gone", "XDG_CACHE_HOME": "/gone"},
        {"LC_ALL": "C"},
        {"LC_ALL": "C.UTF-8"},
        {"LC_ALL": "tr_TR.UTF-8"},
        {"LC_ALL": "gone"},
        {"PYTHONIOENCODING": "ascii"},
        {"PYTHONUTF8": "0", "LC_ALL": "C", "PYTHONCOERCECLOCALE": "0"},
        {"TERM": "gone", "COLUMNS": "0"},
        {"TMPDIR": "/gone"},
        {"PATH": "/gone"},
    ):
        told = " ".join(f"{name}={value or ''}" for name, value in environment.items())
        for words in (ask("--all-pairs"), ("info", "gear.stl"), ("scene", "cell.toml")):
            yield Scenario(told, words, 0, environment=environment)
        words = ("stability", "cube.stl", "apart.obj", "--plot", "new.svg", "-q")
        yield Scenario(told, words, 0, environment=environment, written=("new.svg",))


def limits() -> Iterator[Scenario]:
    """Yield limits of the system on what a process may have."""
    for most in (40, 70, 90):
        limit = _limited(resource.RLIMIT_AS, most << 20)
        for words in (ask("--exit-code"), ("build", "gear.stl", "-o", "old.obbt", "--force")):
            yield Scenario(f"{most} MiB", words, 3, "memory: .*less than", limit=limit)
    for words in (ask(), ("scene", "cell.toml")):
        yield Scenario("8 open files", words, 0, limit=_limited(resource.RLIMIT_NOFILE, 8))
    for words in (ask(), SAVED, ("collide", *GEARS, "--json"), sweep("q.csv", "-o", "out.jsonl")):
        written = ("old.obbt", "out.jsonl")
        yield Scenario("no threads", words, 0, limit=_threadless, written=written)


def all_scenarios() -> Iterator[Scenario]:
    """Yield every fault that needs no right of its own."""
    groups = (full_disks, places, inputs_as_outputs, streams, no_files, names, environments, limits)
    for group in groups:
        yield from group()
