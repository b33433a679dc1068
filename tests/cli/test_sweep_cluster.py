"""`obbtree sweep` on Dask clusters: workers that die, no scheduler, other versions."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
from typing import TYPE_CHECKING

import numpy as np
import pytest
from mesh_files.cube_files import cube, obj, stl

from obbcli import Accuracy, ObbError, ObbTree, __version__, load_mesh
from obbcli.cli import main
from obbcli.sweeps import cluster
from obbcli.sweeps.result_lines import answer_rows
from obbcli.sweeps.row_fields import Row
from obbcli.sweeps.row_questions import SweepSetting

if TYPE_CHECKING:
    from pathlib import Path

WORDS = ("sweep", "cube.stl", "apart.obj", "q.csv", "--duration", "2")
# As of a command, but with chunks of few rows, and for schedulers less patience.
RUN = """
import sys
from obbcli.cli import main
from obbcli.sweeps import cluster, stream
stream._CHUNK_SECONDS = 0.02
cluster._PATIENCE = 1
sys.exit(main(sys.argv[1:]))
"""
# The same, which stops itself as soon as it has written some rows.
STOPPED = (
    """
import os, signal
from obbcli.sweeps import results_file

append = results_file.ResultsFile.append

def stopped(self, block):
    append(self, block)
    results_file.ResultsFile.append = append
    os.kill(os.getpid(), signal.SIGSTOP)

results_file.ResultsFile.append = stopped
"""
    + RUN
)
CLUSTER = """
import distributed
with distributed.LocalCluster(n_workers=1, threads_per_worker=2, dashboard_address=":0") as cluster:
    print(cluster.scheduler_address, flush=True)
    input()
"""


@pytest.fixture(scope="module")
def swept(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, bytes]:
    """Return a folder with questions, and their results without a cluster."""
    here: Path = tmp_path_factory.mktemp("cluster")
    (here / "cube.stl").write_bytes(stl(cube()))
    (here / "apart.obj").write_text(obj(cube((1 + 2**-40, 0, 0))))
    velocities = np.random.default_rng(6).normal((1, 0, 0), size=(3000, 3))
    rows = [f"{k},{' '.join(map(repr, v))}" for k, v in enumerate(velocities.tolist())]
    rows[40] = "40,nowhere"
    (here / "q.csv").write_text("\n".join(["id,vel", *rows, ""]))
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(here)
        assert main([*WORDS, "-o", "whole.jsonl", "--quiet"]) == 3
    return here, (here / "whole.jsonl").read_bytes()


def start(here: Path, *words: str, code: str = RUN) -> subprocess.Popen[str]:
    """Start a sweep in a process of its own."""
    return subprocess.Popen(
        [sys.executable, "-c", code, *WORDS, "--quiet", *words],
        cwd=here,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


@pytest.mark.needs("distributed")
@pytest.mark.xdist_group("cluster")
def test_killed_worker_loses_nothing(swept):
    import psutil

    here, whole = swept
    path = here / "killed.jsonl"
    child = start(here, "-o", path.name, "--workers", "2", code=STOPPED)

    # Nothing more is written until one of the workers is gone.
    state = os.waitid(os.P_PID, child.pid, os.WSTOPPED | os.WEXITED | os.WNOWAIT)
    assert state is not None
    assert state.si_code == os.CLD_STOPPED
    workers = [
        one
        for one in psutil.Process(child.pid).children(recursive=True)
        if any("spawn_main" in word for word in one.cmdline())
    ]
    workers[0].kill()
    size = path.stat().st_size
    child.send_signal(signal.SIGCONT)
    told = child.communicate()[1]

    assert 0 < size < len(whole)
    assert len(workers) == 2
    assert (child.returncode, told) == (3, "")
    assert path.read_bytes() == whole


@pytest.mark.needs("distributed")
@pytest.mark.xdist_group("cluster")
def test_cluster_that_runs_goes_on_with_a_sweep(swept):
    here, whole = swept
    (here / "begun.jsonl").write_bytes(whole[: len(whole) // 3])
    servant = subprocess.Popen(
        [sys.executable, "-c", CLUSTER], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    address = servant.stdout.readline().strip()

    child = start(here, "-o", "begun.jsonl", "--resume", "--scheduler", address)
    told = child.communicate()[1]

    assert (child.returncode, told) == (3, "")
    assert (here / "begun.jsonl").read_bytes() == whole
    assert servant.poll() is None  # it is not ours to stop
    servant.communicate("\n")


@pytest.mark.needs("distributed")
@pytest.mark.xdist_group("cluster")
def test_scheduler_that_is_not_there_is_one_clear_error(swept):
    here, _ = swept
    # A port that is taken, and at which nobody listens.
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        address = f"tcp://127.0.0.1:{taken.getsockname()[1]}"
        child = start(here, "-o", "none.jsonl", "--scheduler", address)
        told = child.communicate()[1]

    assert child.returncode == 3
    assert told.startswith(f"error: scheduler {address}: does not answer: ")
    assert told.endswith("; start one with 'dask scheduler', or use --workers N\n")
    assert told.count("\n") == 1
    assert not (here / "none.jsonl").exists()


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("--workers", "2", "--scheduler", "tcp://here:1"), "--scheduler and --workers say"),
        (("--workers", "2", "--threads", "2"), "--workers and --threads say differently"),
        (("--workers", "0"), "'0' is not a whole number of at least 1"),
    ],
)
def test_rows_are_answered_in_one_place(here, obbtree, words, told):
    ended = obbtree(*WORDS, "-o", "out.jsonl", *words)

    assert ended.code == 2
    assert told in ended.err


def test_missing_package_is_told_by_name(here, obbtree, monkeypatch):
    monkeypatch.setattr("obbcli.cli.commands.sweep.find_spec", lambda _: None)

    ended = obbtree(*WORDS, "-o", "out.jsonl", "--workers", "2")

    assert ended.code == 2
    assert ended.err == (
        "error: --workers: needs the package distributed; install it: pip install distributed\n"
    )


SETTING = SweepSetting({}, degrees=False, accuracy=Accuracy())
ROWS = [Row(0, "q.csv:2", "one", {"vel": (1.0, 0.0, 0.0)})]


@pytest.fixture
def pair(here) -> tuple[ObbTree, ObbTree]:
    return ObbTree.build(load_mesh("cube.stl")), ObbTree.build(load_mesh("apart.obj"), leaf_size=3)


def test_worker_answers_as_this_process_does(pair):
    parcels = [(str(k), tree.to_bytes()) for k, tree in enumerate(pair)]

    block, seconds = cluster.answer_chunk(parcels, ROWS, SETTING, __version__)

    assert block == answer_rows(pair, ROWS, SETTING, 2)
    assert json.loads(block.lines)["time"] == 2**-40
    assert seconds > 0


def test_worker_reads_a_tree_once(pair, monkeypatch):
    monkeypatch.setattr(cluster, "_trees", type(cluster._trees)())
    data = pair[0].to_bytes()

    first = cluster._tree("one", data)

    assert cluster._tree("one", b"") is first
    for k in range(cluster._KEPT):
        cluster._tree(str(k), data)
    assert cluster._tree("one", data) is not first


def test_worker_of_another_version_refuses():
    with pytest.raises(ObbError, match=r"a worker: has obbtree .*, and the sweep is of 0\.0"):
        cluster.answer_chunk([], ROWS, SETTING, "0.0")


class Promise:
    """What a cluster promises, as often as it takes."""

    def __init__(self, client: Client) -> None:
        self.client = client

    def result(self) -> object:
        if self.client.losses:
            raise self.client.losses.pop()
        return "answered"


class Client:
    """A cluster that loses some tasks."""

    def __init__(self, *losses: Exception) -> None:
        self.losses = list(losses)
        self.status = "running"
        self.sendings = 0

    def scatter(self, contents: dict[str, bytes], **_: object) -> dict[str, bytes]:
        self.sendings += 1
        return contents

    def submit(self, *_: object, **__: object) -> Promise:
        return Promise(self)

    def nthreads(self) -> dict[str, int]:
        return {"one": 2, "other": 1}


def test_lost_tasks_are_sent_again_with_the_trees(pair):
    client = Client(RuntimeError("lost"), RuntimeError("lost"))
    tasks = cluster._Tasks(client, pair, SETTING)

    assert tasks.result(ROWS, tasks.submit(ROWS)) == "answered"
    assert client.sendings == 3
    assert tasks.most == 6


def test_tasks_lost_for_good_are_one_clear_error(pair):
    client = Client(*[RuntimeError("lost\nwith a trace")] * 9)
    tasks = cluster._Tasks(client, pair, SETTING)

    with pytest.raises(
        ObbError, match="the cluster: lost rows again and again: RuntimeError: lost;"
    ):
        tasks.result(ROWS, tasks.submit(ROWS))
    assert client.sendings == 1 + cluster._ATTEMPTS


def test_cluster_that_is_gone_is_not_asked_again(pair):
    client = Client(RuntimeError("lost"))
    client.status = "closed"
    tasks = cluster._Tasks(client, pair, SETTING)

    with pytest.raises(ObbError, match=r"the cluster: went away: .* is kept: add --resume"):
        tasks.result(ROWS, tasks.submit(ROWS))
    assert client.sendings == 1


def test_faults_of_rows_are_not_asked_again(pair):
    client = Client(ObbError("a tree", "is damaged"))
    tasks = cluster._Tasks(client, pair, SETTING)

    with pytest.raises(ObbError, match="a tree: is damaged"):
        tasks.result(ROWS, tasks.submit(ROWS))
