"""The errors a caller can meet, each naming place, fault and remedy.

Lowest layer: every other module raises these and imports nothing else to do so.
"""

from __future__ import annotations


class ObbError(ValueError):
    """Base of every error that input or a limit can cause.

    Args:
        where: the place, as finely as it is known: `gear.obj:12`, an argument's name.
        fault: what was found, and what was wanted.
        remedy: what to do about it; may be empty where nothing can be said.
    """

    def __init__(self, where: str, fault: str, remedy: str = "") -> None:
        super().__init__(where, fault, remedy)
        self.where = where
        self.fault = fault
        self.remedy = remedy

    def __str__(self) -> str:
        """Return `where: fault; remedy` in one line."""
        text = f"{self.where}: {self.fault}"
        return f"{text}; {self.remedy}" if self.remedy else text


class MeshError(ObbError):
    """A mesh cannot be read or is refused."""


class TreeFileError(ObbError):
    """A tree file is damaged, of another version, or not a tree file."""


class MotionError(ObbError):
    """A pose, motion, duration or accuracy is not a usable number, or has no meaning there."""


class SceneError(ObbError):
    """A scene file or a scene made in code is not consistent."""


class UnresolvedError(ObbError):
    """A limit was reached before all that was asked was known.

    Args:
        where: the place of the fault.
        fault: what was found and what was wanted.
        remedy: what the user can do.
        time: s; all before it is known. None where that is not a matter of time.
    """

    def __init__(
        self, where: str, fault: str, remedy: str = "", *, time: float | None = None
    ) -> None:
        super().__init__(where, fault, remedy)
        self.time = time
