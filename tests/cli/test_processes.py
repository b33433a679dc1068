"""The command as a process: closed pipes, Ctrl-C, full disks."""

from __future__ import annotations

import json
import os
import re
import resource
import subprocess
import sys
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from collections.abc import Sequence

RUN = "import sys; from obbcli.cli import main; sys.exit(main(sys.argv[1:]))"
# A real signal, sent between two slices of the build. Background jobs of a shell ignore it and hand
# that down, so Python's handler is set anew.
INTERRUPTED_BUILD = """
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)
from obbcli import kernels
from obbcli.cli import main

def interrupted(self, *arguments):
    signal.raise_signal(signal.SIGINT)
    return advance(self, *arguments)

advance = kernels.TreeBuilder.advance
kernels.TreeBuilder.advance = interrupted
sys.exit(main(sys.argv[1:]))
"""

# The same between two slices of a question, the second of which has something proven to tell.
INTERRUPTED_QUERY = """
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)
from obbcli import Query
from obbcli.cli import main

advance = Query.advance

def interrupted(self, *arguments):
    if self.lower_bound > 0:
        signal.raise_signal(signal.SIGINT)
    return advance(self, *arguments)

Query.advance = interrupted
sys.exit(main(sys.argv[1:]))
"""
SAMPLES = Path(__file__).resolve().parents[2] / "sample_meshes"
GEARS = (str(SAMPLES / "gear.stl"), str(SAMPLES / "pinion.stl"))


def run(code: str, words: Sequence[str], **options: object) -> subprocess.CompletedProcess[str]:
    """Run a command line in a fresh interpreter."""
    return subprocess.run(
        [sys.executable, "-c", code, *words],
        stderr=subprocess.PIPE,
        text=True,
        check=False,
        **options,
    )


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (("collide", "cube.stl", "touching.obj", "--all-pairs"), 0),
        (("collide", "cube.stl", "touching.obj", "--json", "--exit-code"), 1),
        (("info", "cube.stl"), 0),
        (("--help",), 0),
        (("collide", "--help"), 0),
        ((), 0),
    ],
)
def test_closed_pipe_ends_the_command_quietly(here: Path, words, code):
    reader, writer = os.pipe()
    os.close(reader)

    ended = run(RUN, words, stdout=writer)

    os.close(writer)
    assert ended.stderr == ""
    assert ended.returncode == code


def test_closed_pipe_under_both_streams_is_quiet(here: Path):
    reader, writer = os.pipe()
    os.close(reader)

    ended = subprocess.run(
        [sys.executable, "-c", RUN, "info", "gone.stl"], stdout=writer, stderr=writer, check=False
    )

    os.close(writer)
    assert ended.returncode == 3


def test_interrupted_build_says_so_in_one_line_and_leaves_nothing(here: Path):
    before = set(here.iterdir())

    ended = run(INTERRUPTED_BUILD, ["build", "cube.stl"], stdout=subprocess.PIPE)

    assert ended.returncode == 130
    assert ended.stdout == ""
    assert ended.stderr == "error: interrupted; nothing was left half written\n"
    assert set(here.iterdir()) == before


@pytest.mark.parametrize("command", ["collide", "first-contact"])
def test_interrupted_question_says_what_is_proven(command):
    words = [command, *GEARS, "--omega", "0", "0", "3", "--omega-b", "0", "0", "-6"]

    ended = run(INTERRUPTED_QUERY, [*words, "--duration", "2"], stdout=subprocess.PIPE)

    told = re.fullmatch(
        r"error: interrupted; no contact before t = (\S+) of 2 s: proven\n", ended.stderr
    )
    assert ended.returncode == 130
    assert ended.stdout == ""
    assert told is not None
    assert 0 < float(told[1]) < 2


@pytest.mark.parametrize(
    "words",
    [
        ("build", "cube.stl"),
        ("info", "cube.stl", "-o", "answer.txt"),
    ],
)
def test_full_disk_is_an_output_fault_and_leaves_nothing(here: Path, words):
    before = set(here.iterdir())

    def limit_files() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100))

    ended = run(RUN, words, stdout=subprocess.PIPE, preexec_fn=limit_files)

    assert ended.returncode == 5
    assert ended.stderr.startswith("error: ")
    assert "cannot be written: File too large" in ended.stderr
    assert ended.stderr.count("\n") == 1
    assert set(here.iterdir()) == before


def test_full_device_is_an_output_fault(here: Path):
    with open("/dev/full", "w", encoding="utf-8") as full:  # noqa: PTH123  # a device
        ended = run(RUN, ["collide", "cube.stl", "apart.obj"], stdout=full)

    assert ended.returncode == 5
    assert ended.stderr == "error: standard output: cannot be written: No space left on device\n"


def test_names_that_the_output_cannot_hold_are_escaped(here: Path):
    (here / "gér.stl").write_bytes((here / "cube.stl").read_bytes())
    environment = {**os.environ, "PYTHONIOENCODING": "ascii", "PYTHONUTF8": "0"}

    ended = run(RUN, ["info", "gér.stl"], stdout=subprocess.PIPE, env=environment)

    assert ended.returncode == 0
    assert "g\\xe9r.stl (mesh)" in ended.stdout


def test_colour_is_left_out_on_request(here: Path):
    environment = {**os.environ, "FORCE_COLOR": "1", "NO_COLOR": "1", "TERM": "xterm-256color"}

    ended = run(RUN, ["info", "cube.stl"], stdout=subprocess.PIPE, env=environment)

    assert ended.returncode == 0
    assert "\x1b[3" not in ended.stdout


@pytest.mark.parametrize("name", ["cube.stl", "touching.obj", "cube.obbt"])
def test_process_substitution_is_read_by_its_content(here: Path, name):
    run(RUN, ["build", "cube.stl"], stdout=subprocess.DEVNULL)
    line = f'"$0" -c "$1" collide touching.obj <(cat {name}) --json -q'

    ended = subprocess.run(
        ["bash", "-c", line, sys.executable, RUN], capture_output=True, text=True, check=False
    )

    document = json.loads(ended.stdout)
    assert (ended.returncode, ended.stderr) == (0, "")
    assert document["result"]["status"] == "overlap_at_start"
    assert document["inputs"]["b"]["sha256"] == sha256((here / name).read_bytes()).hexdigest()


def test_named_pipe_is_read_by_its_suffix(here: Path):
    os.mkfifo(here / "pipe.obj")
    writer = subprocess.Popen(["cp", "touching.obj", "pipe.obj"])

    ended = run(RUN, ["info", "pipe.obj", "--json"], stdout=subprocess.PIPE)

    assert writer.wait() == 0
    assert json.loads(ended.stdout)["result"]["triangle_count"] == 12
