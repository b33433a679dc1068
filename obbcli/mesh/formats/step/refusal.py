"""`StepError`: what the worker process refuses a file for, as plain words that cross a pipe."""

from __future__ import annotations


class StepError(Exception):
    """Tells why a file is refused.

    Args:
        fault: what is wrong.
        remedy: what to do about it.
        at: where in the file, such as `#123`; empty for the file as a whole.
    """

    def __init__(self, fault: str, remedy: str = "", at: str = "") -> None:
        super().__init__(fault)
        self.words = (fault, remedy, at)
