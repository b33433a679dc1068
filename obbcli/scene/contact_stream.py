"""`ContactStream`: contacts of a scene, found step by step: what questions about scenes return."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator
from typing import TYPE_CHECKING

from obbcli.scene.results import SceneContact, SceneStats

if TYPE_CHECKING:
    from obbcli.scene.pairs import ScenePairs


class ContactStream(Iterator[SceneContact]):
    """Contacts of a scene in order of time.

    Args:
        asked: bodies and pairs.

    Attributes:
        asked: the bodies and pairs of the question.
    """

    def __init__(self, asked: ScenePairs) -> None:
        self.asked = asked

    @property
    @abstractmethod
    def time(self) -> float:
        """Up to when all is known and was yielded, s; the duration when nothing is left."""

    @property
    @abstractmethod
    def is_finished(self) -> bool:
        """Whether all that was asked for was yielded."""

    @property
    @abstractmethod
    def stats(self) -> SceneStats:
        """What became of the pairs so far, and what it took."""

    @abstractmethod
    def advance(self) -> SceneContact | None:
        """Go on for some milliseconds; return the next contact where that finds it.

        Raises:
            ObbError: as `__next__`.
        """

    @abstractmethod
    def stop(self) -> None:
        """Give up: what is not known yet comes next, as unresolved."""

    def __next__(self) -> SceneContact:
        """Return the next contact.

        Raises:
            MeshError: a mesh is refused.
            MotionError: positions leave the range of double, or sampled steps turn by more than
                their integrator can follow.
            TreeFileError: a tree file is damaged.
        """
        while not self.is_finished:
            found = self.advance()
            if found is not None:
                return found
        raise StopIteration
