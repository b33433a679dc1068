"""How a question ended, in words."""

from __future__ import annotations

from enum import Enum
from typing import Literal, TypeAlias

from obbcli.errors import UnresolvedError

# The body that lies inside the other, or a part of it does.
Inner: TypeAlias = Literal["a", "b"]


class Status(str, Enum):
    """How a question ended; the values are the words of the JSON documents."""

    SEPARATED = "separated"
    """No contact in the whole closed interval: a proof, unless the answer was sampled."""
    CONTACT = "contact"
    """First contact at a time later than 0."""
    OVERLAP_AT_START = "overlap_at_start"
    """Contact at t = 0, touching included; also of bodies at rest."""
    UNRESOLVED = "unresolved"
    """A limit was reached before the answer was known."""

    def __str__(self) -> str:
        """Return the bare word."""
        return self.value


def is_contact(status: Status) -> bool:
    """Return whether bodies touch.

    Raises:
        UnresolvedError: a limit was reached before the answer was known.
    """
    if status is Status.UNRESOLVED:
        raise UnresolvedError(
            "collides",
            "the question stopped at a limit before its answer was known",
            "raise max_iterations or timeout",
        )
    return status is not Status.SEPARATED
