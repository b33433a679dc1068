"""The process in which Open CASCADE works: bytes in, triangles out.

Damaged files end the library with a fault of memory, or never, one in a dozen of those tried. What
happens here ends this process alone, which can open no file, takes bounded memory and time, and
prints nothing: its answers leave through the pipe that was its standard output.
"""

from __future__ import annotations

import json
import os
import resource
import signal
import sys
from contextlib import suppress
from typing import TYPE_CHECKING, Any, BinaryIO

if TYPE_CHECKING:
    from obbcli.mesh.formats.step.document import StepDocument


def main() -> None:
    """Answer what the parent process asks, until it closes its end.

    It sends a line of JSON, `{"bytes": N, "sag": D, "memory": M, "seconds": S}`, and the N bytes of
    the file: this process takes M bytes of memory at most, and S seconds of processor time for
    reading the file and for each product. The answer is a line of JSON as `_about` makes it. Then
    it sends a number of a product a line; the answer is a line of JSON, and the arrays that it
    counts. Where something is refused, the line is `{"refused": [fault, remedy, place]}`.
    """
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    answers = os.fdopen(os.dup(1), "wb")
    silence = os.open(os.devnull, os.O_RDWR)
    os.dup2(silence, 1)
    os.dup2(silence, 2)
    questions = sys.stdin.buffer
    wanted = json.loads(questions.readline())
    data = questions.read(wanted["bytes"])
    _say(answers, _opened(data, wanted, answers, questions))


def _opened(
    data: bytes, wanted: dict[str, Any], answers: BinaryIO, questions: BinaryIO
) -> dict[str, Any]:
    """Answer questions about a file; return what is left to say when that ends."""
    from obbcli.mesh.formats.step.document import StepDocument
    from obbcli.mesh.formats.step.refusal import StepError
    from obbcli.mesh.formats.step.tessellation import tessellated

    seconds = wanted["seconds"]
    _confine(wanted["memory"])
    product = -1
    try:
        _allow(seconds)
        document = StepDocument(data)
        _say(answers, _about(document))
        for line in questions:
            product = int(line)
            _allow(seconds)
            cut = tessellated(document.shapes[product], wanted["sag"], document.length.exponent)
            counts = {"vertices": len(cut.vertices), "triangles": len(cut.triangles)}
            about = {"sag": cut.sag, "faces": cut.face_count, "open": cut.open_edge_count}
            _say(answers, counts | about)
            answers.write(cut.vertices.tobytes())
            answers.write(cut.triangles.tobytes())
            answers.flush()
    except StepError as fault:
        return {"refused": fault.words, "product": product}
    except MemoryError:
        return {"refused": ["does not fit into memory", "split the file", ""], "product": product}
    except Exception:  # noqa: BLE001 - the library's own, of any class
        words = ["cannot be translated: Open CASCADE gives up", "export it again, or as STL", ""]
        return {"refused": words, "product": product}
    return {}


def _about(document: StepDocument) -> dict[str, Any]:
    """Return what is told of a file before any product is cut."""
    nodes = [
        (depth, name, product, None if matrix is None else matrix.ravel().tolist())
        for depth, name, product, matrix in document.nodes
    ]
    return {
        "unit": document.length.unit,
        "notes": document.notes,
        "names": document.names,
        "nodes": nodes,
    }


def _say(answers: BinaryIO, words: dict[str, Any]) -> None:
    with suppress(BrokenPipeError):
        answers.write(json.dumps(words).encode() + b"\n")
        answers.flush()


def _confine(memory: int) -> None:
    """Let this process open no more files, and take no more memory than so many bytes."""
    # Where the system knows no such limit, there is none.
    with suppress(OSError, ValueError):
        resource.setrlimit(resource.RLIMIT_NOFILE, (0, 0))
    with suppress(OSError, ValueError):
        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))


def _allow(seconds: int) -> None:
    """Let this process run for so many s of processor time from now on, then end it."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    limit = int(used.ru_utime + used.ru_stime) + seconds
    with suppress(OSError, ValueError):
        _, hard = resource.getrlimit(resource.RLIMIT_CPU)
        resource.setrlimit(resource.RLIMIT_CPU, (limit, hard))
