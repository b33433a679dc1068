"""What a process of the command line is to signals and to closed streams.

Python raises `KeyboardInterrupt` wherever it is when a signal comes: among imports, where libraries
take it for a fault of theirs, in callbacks, whose exceptions are printed and lost, or while it
ends. Here it waits until a command listens, and is raised in the command's own code alone.
"""

from __future__ import annotations

import os
import signal
import sys

from obbcli.errors import ObbError

TYPE_CHECKING = False  # that of `typing`, whose import signals would wait for
if TYPE_CHECKING:
    from sys import UnraisableHookArgs
    from types import FrameType

# A terminal's Ctrl-C, whoever ends processes, and a terminal that is closed.
ENDING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
# s until a signal that came at a bad moment is looked at again.
_RETRY = 0.01
_IMPORTING = "<frozen importlib"
# Bytes of address space that NumPy, its linear algebra and the kernels take: about 80 MiB.
_ROOM = 96 << 20


class Signals:
    """Whether an end that is asked for may interrupt.

    Attributes:
        are_heard: set by whoever would catch `KeyboardInterrupt`; plainly, since Python looks at
            signals in every call.
    """

    def __init__(self) -> None:
        self.are_heard = False
        self._handled: list[signal.Signals] = []
        self._base: FrameType | None = None

    def install(self) -> None:
        """Take over those signals that nobody else ignores or handles, as `nohup` does."""
        self._base = sys._getframe(1)
        defaults = (signal.SIG_DFL, signal.default_int_handler)
        self._handled = [number for number in ENDING if signal.getsignal(number) in defaults]
        for number in (*self._handled, signal.SIGALRM):
            signal.signal(number, self._arrived)
        sys.unraisablehook = self._unraisable

    def leave(self) -> None:
        """Ignore what still comes: the answer is out, and the process ends by itself."""
        self.are_heard = False
        signal.setitimer(signal.ITIMER_REAL, 0)
        for number in (*self._handled, signal.SIGALRM):
            signal.signal(number, signal.SIG_IGN)

    def _arrived(self, _number: int, frame: FrameType | None) -> None:
        if self.are_heard and not self._is_importing(frame):
            raise KeyboardInterrupt
        signal.setitimer(signal.ITIMER_REAL, _RETRY)

    def _is_importing(self, frame: FrameType | None) -> bool:
        """Return whether an import runs, of those that began after `install`."""
        while frame is not None and frame is not self._base:
            if frame.f_code.co_filename.startswith(_IMPORTING):
                return True
            frame = frame.f_back
        return False

    def _unraisable(self, fault: UnraisableHookArgs) -> None:
        """Try again what was raised where nobody could catch it."""
        if issubclass(fault.exc_type, KeyboardInterrupt):
            signal.setitimer(signal.ITIMER_REAL, _RETRY)
        else:
            sys.__unraisablehook__(fault)


SIGNALS = Signals()


def check_room() -> None:
    """Refuse to start where libraries would not get the memory that they need to be loaded.

    Some end the process, with an exit code that has another meaning here, others blame an import.

    Raises:
        ObbError: a limit of the process leaves less than they need.
    """
    import resource

    if resource.getrlimit(resource.RLIMIT_AS)[0] == resource.RLIM_INFINITY:
        return
    import mmap

    try:
        mmap.mmap(-1, _ROOM).close()
    except OSError as fault:
        told = f"the limit on this process leaves less than {_ROOM >> 20} MiB to start with"
        raise ObbError("memory", told, "raise it, as ulimit -v does") from fault


def open_closed_streams() -> None:
    """Put the null device where standard streams are closed.

    The next file to be opened would be in their place, and get what is meant for them. Python has
    seen by now that they are closed.
    """
    for number in (0, 1, 2):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # the lowest number that is free
