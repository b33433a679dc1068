"""Rows to results on a Dask cluster: one that runs, or workers started for the sweep.

The trees travel once, as the bytes of tree files, and stay with the workers. Chunks of rows are
tasks, of which a bounded number is under way; whatever a lost worker leaves undone is done again.
"""

from __future__ import annotations

import asyncio
import logging
import signal
import time
from collections import OrderedDict, deque
from contextlib import ExitStack, contextmanager
from hashlib import sha256
from itertools import islice
from threading import Lock
from typing import TYPE_CHECKING, Any

from obbcli.errors import ObbError
from obbcli.sweeps.result_lines import answer_rows
from obbcli.sweeps.stream import Chunks
from obbcli.tree.tree import ObbTree
from obbcli.version import __version__

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from obbcli.questions.pair_question import Trees
    from obbcli.sweeps.result_lines import Block
    from obbcli.sweeps.row_fields import Row
    from obbcli.sweeps.row_questions import SweepSetting

# s to find a scheduler, and for it to have a worker.
_PATIENCE = 5
_WORKER_PATIENCE = 30
# Under way for each thread of the workers: one that works, one that waits.
_CHUNKS_A_THREAD = 2
# How often a chunk is asked for that gets lost.
_ATTEMPTS = 5
# Trees that a worker keeps: those of a few sweeps.
_KEPT = 4

_trees: OrderedDict[str, ObbTree] = OrderedDict()
_lock = Lock()


def answer_chunk(
    parcels: Sequence[tuple[str, bytes]], rows: Sequence[Row], setting: SweepSetting, version: str
) -> tuple[Block, float]:
    """Return the results of some rows and the s they took; runs on a worker.

    Raises:
        ObbError: the worker has another version of this package, or a tree is damaged.
    """
    if version != __version__:
        fault = f"has obbtree {__version__}, and the sweep is of {version}"
        raise ObbError("a worker", fault, "install the same version on all machines")
    a, b = (_tree(*parcel) for parcel in parcels)
    start = time.perf_counter()
    block = answer_rows((a, b), rows, setting, 1)
    return block, time.perf_counter() - start


def _tree(digest: str, data: bytes) -> ObbTree:
    """Return the tree in the bytes of its file, which a worker reads once."""
    with _lock:
        tree = _trees.pop(digest, None)
        if tree is None:
            tree = ObbTree.from_bytes(data, "a tree that was sent")
        _trees[digest] = tree
        while len(_trees) > _KEPT:
            _trees.popitem(last=False)
    return tree


def dask_setup(_worker: object) -> None:
    """Leave Ctrl-C to the process that started the workers; called in each of them."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


@contextmanager
def connected(address: str | None, workers: int | None) -> Iterator[Any]:
    """Connect to a cluster, or start one on this machine; it is left, or stopped, at the end.

    Args:
        address: of a scheduler that runs.
        workers: without one, how many processes to start.

    Yields:
        a `distributed.Client`.

    Raises:
        ObbError: no scheduler answers, or it has no workers.
    """
    import distributed

    with ExitStack() as stack:
        stack.enter_context(_silence())
        if address is None:
            cluster = distributed.LocalCluster(
                n_workers=workers,
                threads_per_worker=1,
                processes=True,
                host="127.0.0.1",
                # The address alone would still open the well-known port of the dashboard.
                dashboard_address="127.0.0.1:0",
                scheduler_kwargs={"dashboard": False},
                silence_logs=logging.CRITICAL,
                preload=[__name__],
            )
            stack.enter_context(cluster)
            yield stack.enter_context(distributed.Client(cluster, set_as_default=False))
            return
        try:
            client = distributed.Client(address, timeout=_PATIENCE, set_as_default=False)
        except (OSError, ValueError, TypeError) as fault:
            said = str(fault).partition("\n")[0]
            remedy = "start one with 'dask scheduler', or use --workers N"
            raise ObbError(f"scheduler {address}", f"does not answer: {said}", remedy) from fault
        stack.enter_context(client)
        try:
            client.wait_for_workers(1, timeout=_WORKER_PATIENCE)
        except (TimeoutError, asyncio.TimeoutError) as fault:  # one and the same from 3.11 on
            remedy = f"start some with 'dask worker {address}'"
            raise ObbError(f"scheduler {address}", "has no workers", remedy) from fault
        yield client


@contextmanager
def _silence() -> Iterator[None]:
    """Keep what Dask logs from the screen: all that matters comes back as an error."""
    names = [name for name in logging.root.manager.loggerDict if name.startswith("distributed")]
    levels = [(logging.getLogger(name), logging.getLogger(name).level) for name in names]
    for logger, _ in levels:
        logger.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        for logger, level in levels:
            logger.setLevel(level)


def answered_by(
    client: Any, trees: Trees, rows: Iterator[Row], setting: SweepSetting
) -> Iterator[Block]:
    """Yield the results of rows in order, as `answered` does, from a cluster.

    Raises:
        ObbError: the rows cannot be read on, a tree is damaged, or the cluster is gone.
    """
    tasks = _Tasks(client, trees, setting)
    chunks = Chunks(1)
    pending: deque[tuple[Sequence[Row], Any]] = deque()
    try:
        while True:
            while len(pending) < tasks.most and (some := list(islice(rows, chunks.row_count))):
                pending.append((some, tasks.submit(some)))
            if not pending:
                return
            asked, future = pending[0]
            block, seconds = tasks.result(asked, future)
            pending.popleft()
            chunks.measured(len(asked), seconds)
            yield block
    finally:
        for _, future in pending:
            future.cancel()


class _Tasks:
    """What is sent to a cluster, and sent again where it got lost."""

    def __init__(self, client: Any, trees: Trees, setting: SweepSetting) -> None:
        self._client = client
        self._setting = setting
        contents = [tree.to_bytes() for tree in trees[: 1 if trees[0] is trees[1] else 2]]
        self._contents = {sha256(data).hexdigest(): data for data in contents}
        digests = list(self._contents)
        self._digests = digests[0], digests[-1]
        self._sent = self._send()
        self.most = _CHUNKS_A_THREAD * max(sum(client.nthreads().values()), 1)

    def _send(self) -> dict[str, Any]:
        """Give every worker the trees."""
        sent: dict[str, Any] = self._client.scatter(self._contents, broadcast=True, hash=False)
        return sent

    def submit(self, rows: Sequence[Row]) -> Any:
        """Return the promise of some rows' results."""
        parcels = [(digest, self._sent[digest]) for digest in self._digests]
        return self._client.submit(
            answer_chunk, parcels, rows, self._setting, __version__, pure=False
        )

    def result(self, rows: Sequence[Row], future: Any) -> tuple[Block, float]:
        """Return some rows' results; what dies with its worker is asked for again.

        Raises:
            ObbError: it is the rows' own fault, or nobody answers any more.
        """
        what = "lost rows again and again"
        for _ in range(_ATTEMPTS):
            try:
                found: tuple[Block, float] = future.result()
            except ObbError:
                raise
            except Exception as fault:  # noqa: BLE001  # of many kinds: killed, cancelled, lost
                last = fault
            else:
                return found
            if self._client.status != "running":
                what = "went away"
                break
            self._sent = self._send()
            future = self.submit(rows)
        said = f"{type(last).__name__}: {last}".partition("\n")[0]
        remedy = "look at its workers; what was answered is kept: add --resume to go on"
        raise ObbError("the cluster", f"{what}: {said}", remedy) from last
