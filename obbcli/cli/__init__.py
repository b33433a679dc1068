"""The shell's side of the tool: parse, call, render. One command a file.

Exit codes and what goes to which stream are in `boundary`.
"""

from __future__ import annotations

import gc
import os
import sys

from obbcli.cli.process import SIGNALS, check_room, open_closed_streams

# That of `typing`: until `run_process` begins, Ctrl-C finds Python's own handler.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence

PROGRAM = "obbtree"

# Objects made between two looks for cycles. Imports make tens of thousands, all of which stay.
_OBJECTS_A_COLLECTION = 100_000


def run_process() -> int:
    """Run this process's command line and return its exit code, for a process that ends then."""
    SIGNALS.install()
    open_closed_streams()
    gc.set_threshold(_OBJECTS_A_COLLECTION)
    try:
        return main()
    finally:
        SIGNALS.leave()
        # The end of the process frees all memory: looking for cycles in it would cost a tenth of a
        # short command's time.
        gc.freeze()


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command line and return its exit code; never raises, never prints a stray traceback.

    Args:
        arguments: the words after the program's name. None: those of this process.
    """
    # Imported here, where a signal that comes meanwhile can wait.
    from obbcli.cli.app import app
    from obbcli.cli.boundary import guarded

    # No command calls BLAS, and starting its threads costs a tenth of NumPy's import.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    words = list(sys.argv[1:] if arguments is None else arguments)
    if "_OBBTREE_COMPLETE" in os.environ:
        # The shell asks for completions: click answers and exits by itself.
        app.main(words, prog_name=PROGRAM)
    # A copy, because click empties the list that it parses.
    return guarded(lambda: run(list(words)), words)


def run(words: list[str]) -> int:
    """Parse and run one command; return its exit code."""
    from obbcli.cli.app import app

    check_room()
    with app.make_context(PROGRAM, words) as context:
        return int(app.invoke(context) or 0)
