"""`StepProcess`: a file in a worker process, asked for its products one by one."""

from __future__ import annotations

import json
import os
import signal
import sys
import weakref
from contextlib import suppress
from threading import Lock
from typing import TYPE_CHECKING, Any, NamedTuple, NoReturn

import numpy as np

from obbcli.mesh.source import most_bytes

if TYPE_CHECKING:
    from subprocess import Popen

    from obbcli.mesh.source import MeshArrays, Source

# What is imported is what this process would import, in whatever way its path came about.
_START = "import sys; sys.path[:] = {path!r}; from {module} import main; main()"
_WORKER = "obbcli.mesh.formats.step.worker"
_INSTALL = "install it: pip install cadquery-ocp-novtk"
#: s of processor time for reading a file, and for cutting one product: so many, and so many more
#: for each MB of the file.
SECONDS, SECONDS_A_MB = 40, 40
#: Bytes that the library and an interpreter reserve before they read anything.
_BASE_BYTES = 4 << 30
_AGAIN = "export it again, or as STL"


class Cut(NamedTuple):
    """Holds a product cut into triangles.

    Attributes:
        arrays: vertices and triangles.
        sag: how far these are from the exact surfaces at most.
        face_count: how many faces were cut.
        open_edge_count: edges of solids that no two triangles share.
    """

    arrays: MeshArrays
    sag: float
    face_count: int
    open_edge_count: int


class StepProcess:
    """Keeps a file open in a worker process, as long as someone may ask for its products.

    Args:
        source: the file; its `sag` is what products are cut with.

    Attributes:
        about: what the worker tells of the file: unit, notes, names, nodes.

    Raises:
        MeshError: the library is missing, or the file is refused; also from `cut`.
    """

    def __init__(self, source: Source) -> None:
        self._source = source
        self._lock = Lock()
        self._process: Popen[bytes] | None = None
        self._owner = 0
        self.about = self._start()

    def cut(self, product: int) -> Cut:
        """Return a product cut into triangles."""
        with self._lock:
            # A fork of this process has a worker of its own.
            if self._process is None or self._owner != os.getpid():
                self._start()
            self._send(f"{product}\n".encode())
            told = self._answer(product)
            vertices = self._array(np.float64, told["vertices"], product)
            triangles = self._array(np.int64, told["triangles"], product)
        return Cut((vertices, triangles), told["sag"], told["faces"], told["open"])

    def _start(self) -> dict[str, Any]:
        """Start a worker, give it the file, and return what it tells of it."""
        import subprocess
        from importlib.util import find_spec

        source = self._source
        if find_spec("OCP") is None:
            fault = "is a STEP file, which takes the package cadquery-ocp-novtk"
            raise source.error(fault, _INSTALL)
        self._process = subprocess.Popen(
            [sys.executable, "-c", _START.format(path=sys.path, module=_WORKER)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )
        self._owner = os.getpid()
        weakref.finalize(self, _end, self._process, self._owner)
        size = len(source.data)
        wanted = {
            "bytes": size,
            "sag": source.sag,
            "memory": _BASE_BYTES + most_bytes(),
            "seconds": SECONDS + SECONDS_A_MB * size // 1_000_000,
        }
        self._send(json.dumps(wanted).encode() + b"\n" + source.data)
        return self._answer(None)

    def _send(self, words: bytes) -> None:
        assert self._process is not None
        assert self._process.stdin is not None
        # Whoever does not listen any more has something to say.
        with suppress(BrokenPipeError):
            self._process.stdin.write(words)
            self._process.stdin.flush()

    def _answer(self, product: int | None) -> dict[str, Any]:
        """Return what the worker says next."""
        assert self._process is not None
        assert self._process.stdout is not None
        line = self._process.stdout.readline()
        if not line.endswith(b"\n"):
            self._refuse_end(product)
        told: dict[str, Any] = json.loads(line)
        if "refused" in told:
            self._close()
            fault, remedy, place = told["refused"]
            raise self._source.error(fault, remedy, at=self._place(product, place))
        return told

    def _array(self, kind: type, rows: int, product: int) -> Any:
        """Return an array (rows, 3) that the worker sends."""
        assert self._process is not None
        assert self._process.stdout is not None
        size = rows * 3 * np.dtype(kind).itemsize
        data = self._process.stdout.read(size)
        if len(data) != size:
            self._refuse_end(product)
        return np.frombuffer(data, dtype=kind).reshape(-1, 3)

    def _refuse_end(self, product: int | None) -> NoReturn:
        """Refuse a file at which the worker ended."""
        assert self._process is not None
        code = self._process.wait()
        self._close()
        at = self._place(product, "")
        if code == -signal.SIGXCPU:
            fault = "takes Open CASCADE too long"
            raise self._source.error(fault, f"take a larger sag, or {_AGAIN}", at=at)
        if code == 1 and product is None:
            fault = "takes the package cadquery-ocp-novtk, which cannot be imported"
            raise self._source.error(fault, _INSTALL)
        fault = "ends Open CASCADE, which translates it, with a fault of its own"
        raise self._source.error(fault, f"it may be damaged: {_AGAIN}", at=at)

    def _place(self, product: int | None, place: str) -> str:
        """Return the words for a place in a product, or in the file."""
        name = "" if product is None else self.about["names"][product]
        return " of ".join(filter(None, (place, f"product '{name}'" if name else "")))

    def _close(self) -> None:
        if self._process is not None:
            _end(self._process, self._owner)
            self._process = None


def _end(process: Popen[bytes], owner: int) -> None:
    """End a worker; one that another process started is left to that."""
    for pipe in (process.stdin, process.stdout):
        if pipe is not None:
            with suppress(OSError):
                pipe.close()
    if owner == os.getpid():
        process.kill()
        process.wait()
