"""`obbtree sweep --resume`: whatever ends a sweep, no row is lost, doubled or mixed with others."""

from __future__ import annotations

import resource
import signal
import subprocess
import sys
import time
from typing import TYPE_CHECKING

import numpy as np
import pytest

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

WORDS = ("sweep", "cube.stl", "apart.obj", "q.csv", "--duration", "2")
# Chunks of few rows, so that there are many moments to be interrupted at.
RUN = """
import sys
from obbcli.cli import main
from obbcli.sweeps import stream
stream._CHUNK_SECONDS = 0.004
sys.exit(main(sys.argv[1:]))
"""
# Killed in the middle of a write, after so many bytes.
KILLED = """
import os, signal, sys
from obbcli.cli import main
from obbcli.sweeps import results_file, stream
stream._CHUNK_SECONDS = 0.004
write = results_file.ResultsFile._write
left = int(sys.argv.pop(1))

def torn(self, data):
    global left
    if len(data) > left:
        os.write(self._handle, data[:left])
        os.kill(os.getpid(), signal.SIGKILL)
    left -= len(data)
    write(self, data)

results_file.ResultsFile._write = torn
sys.exit(main(sys.argv[1:]))
"""
# A real signal, once some rows are written.
INTERRUPTED = """
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)
from obbcli.cli import main
from obbcli.sweeps import results_file

append = results_file.ResultsFile.append

def interrupted(self, block):
    append(self, block)
    if self.row_count > 16:
        signal.raise_signal(signal.SIGINT)

results_file.ResultsFile.append = interrupted
sys.exit(main(sys.argv[1:]))
"""


def start(code: str, words: Sequence[str], **options: object) -> subprocess.Popen[str]:
    """Start a command line in a fresh interpreter."""
    return subprocess.Popen(
        [sys.executable, "-c", code, *words],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        **options,
    )


def test_sweeps_killed_while_they_write_go_on_without_losing_or_doubling_a_row(here, asked):
    path = here / "out.jsonl"
    sizes = [100, *np.random.default_rng(12).integers(1, len(asked) // 5, 5).tolist(), len(asked)]
    for size in sizes:
        child = start(KILLED, [str(size), *WORDS, "-o", "out.jsonl", "--resume"])
        child.communicate()

        assert child.returncode == (3 if size == sizes[-1] else -signal.SIGKILL)
        assert asked.startswith(path.read_bytes())

    assert path.read_bytes() == asked


def test_sweeps_killed_at_any_moment_go_on(here: Path, asked):
    path = here / "out.jsonl"
    rng = np.random.default_rng(11)
    code = None
    while code != 3:
        resumed = ["--resume"] if path.exists() else []
        child = start(RUN, [*WORDS, "-o", "out.jsonl", *resumed, "--threads", "2"])
        before = path.stat().st_size if path.exists() else 0
        enough = before + rng.integers(1, len(asked) // 4)
        while child.poll() is None:
            if path.exists() and path.stat().st_size >= enough:
                child.send_signal(signal.SIGKILL)
                break
            time.sleep(0.001)  # leaves the core to the child
        child.communicate()
        code = child.returncode
        assert code in (3, -signal.SIGKILL)
        # The size may fall when a torn line is cut, but no whole line goes.
        assert asked.startswith(path.read_bytes())

    assert path.read_bytes() == asked


def test_interrupted_sweep_keeps_what_it_has_and_says_so(here: Path, asked):
    child = start(INTERRUPTED, [*WORDS, "-o", "out.jsonl"])
    _, told = child.communicate()

    kept = (here / "out.jsonl").read_bytes()
    rows = kept.count(b"\n") - 1
    assert child.returncode == 130
    assert told == f"error: interrupted; {rows} rows are in out.jsonl: add --resume to go on\n"
    assert 16 < rows < 300
    assert asked.startswith(kept)


def test_every_cut_is_mended(here: Path, asked, obbtree):
    path = here / "out.jsonl"
    starts = [0, *(k + 1 for k, byte in enumerate(asked) if byte == ord("\n"))]
    cuts = {0, 1, starts[1] - 1, starts[1], starts[1] + 1, starts[-1] - 1, starts[-1]}
    cuts |= set(np.random.default_rng(3).integers(0, len(asked), 12).tolist())

    for cut in sorted(cuts):
        path.write_bytes(asked[:cut])
        ended = obbtree(*WORDS, "-o", path.name, "--resume", "--quiet")

        assert (ended.code, ended.err) == (3, ""), cut
        assert path.read_bytes() == asked, cut


def test_finished_sweep_has_nothing_to_add(here: Path, asked, obbtree):
    first = obbtree(*WORDS, "-o", "whole.jsonl", "--resume", "--json")

    assert first.json["result"]["resumed_from"] == first.json["result"]["row_count"] == 300
    assert first.json["result"]["error_count"] == 1
    assert first.code == 3
    assert (here / "whole.jsonl").read_bytes() == asked


@pytest.mark.parametrize("words", [("--threads", "1"), ("--threads", "5")])
def test_threads_change_no_byte(here: Path, asked, obbtree, words):
    obbtree(*WORDS, "-o", "other.jsonl", *words)

    assert (here / "other.jsonl").read_bytes() == asked


def test_force_starts_again(here: Path, asked, obbtree):
    (here / "out.jsonl").write_bytes(b"of no use\n" + asked)

    obbtree(*WORDS, "-o", "out.jsonl", "--force")

    assert (here / "out.jsonl").read_bytes() == asked


@pytest.mark.parametrize("size", [100, 4000])
def test_full_disk_is_an_output_fault_and_can_be_resumed(here: Path, asked, obbtree, size):
    def limit_files() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    child = start(RUN, [*WORDS, "-o", "out.jsonl"], preexec_fn=limit_files)
    _, told = child.communicate()

    assert child.returncode == 5
    assert told == "error: out.jsonl: cannot be written: File too large\n"
    assert (here / "out.jsonl").read_bytes() == asked[:size]
    obbtree(*WORDS, "-o", "out.jsonl", "--resume")
    assert (here / "out.jsonl").read_bytes() == asked


def test_full_device_is_an_output_fault_of_sweeps(here: Path, asked, obbtree):
    ended = obbtree(*WORDS, "-o", "/dev/full")

    assert ended.code == 5
    assert ended.err == "error: /dev/full: cannot be written: No space left on device\n"


@pytest.mark.parametrize("words", [(), ("--resume",)])
def test_device_takes_results_as_they_come(here: Path, asked, words):
    child = start(RUN, [*WORDS, "-o", "/dev/stderr", "--quiet", *words])
    _, lines = child.communicate()

    assert child.returncode == 3
    assert lines.encode() == asked


def test_standard_input_is_swept_and_resumed(here: Path, asked):
    words = [*(word if word != "q.csv" else "-" for word in WORDS), "-o", "out.jsonl", "--quiet"]
    with (here / "q.csv").open() as rows:
        start(RUN, words, stdin=rows).communicate()
    whole = (here / "out.jsonl").read_bytes()
    (here / "out.jsonl").write_bytes(whole[:9000])

    with (here / "q.csv").open() as rows:
        start(RUN, [*words, "--resume"], stdin=rows).communicate()

    assert (here / "out.jsonl").read_bytes() == whole
    # But for the names of their file, these are the same rows.
    assert whole.split(b"\n", 42)[42] == asked.split(b"\n", 42)[42]
