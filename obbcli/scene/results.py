"""What a scene answers: `SceneContact`, and `SceneStats` with all that it took, all frozen."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Mapping

    from obbcli.answers.contact import Contact
    from obbcli.answers.status import Status


@dataclass(frozen=True)
class SceneContact:
    """When and where two bodies of a scene first touch.

    Attributes:
        body_a: the name of A, of the two bodies the one that comes first in the scene.
        body_b: the name of B.
        contact: the contact, as `first_contact` has it. Its status is `unresolved` where a limit
            was reached: then nothing is known of the pair after its `time`.
    """

    body_a: str
    body_b: str
    contact: Contact

    @property
    def status(self) -> Status:
        """How the question about the two ended."""
        return self.contact.status

    @property
    def time(self) -> float:
        """No contact of the two before this, s: proven, unless sampled."""
        assert self.contact.time is not None
        return self.contact.time

    @property
    def part_a(self) -> str | None:
        """The path of the part of `body_a` that touches, where `FILE#PATTERN` selected parts."""
        return self.contact.part_a

    @property
    def part_b(self) -> str | None:
        """The path of the part of `body_b` that touches, likewise."""
        return self.contact.part_b


class BodyStats(NamedTuple):
    """What of a body was used.

    Attributes:
        name: the body's.
        triangle_count: of its mesh; None where nobody looked at it.
        triangles_loaded: how many of them were read. Bodies of one mesh share them.
        nodes_built: nodes of its tree that were made, or read from a tree file.
        nodes_possible: nodes that its tree can have.
    """

    name: str
    triangle_count: int | None
    triangles_loaded: int
    nodes_built: int
    nodes_possible: int | None


class SceneStats(NamedTuple):
    """What became of the pairs of a scene, and what it cost to know.

    Attributes:
        pairs: all pairs of bodies that the question was about.
        static: those of them of two static bodies, which are not asked about.
        ignored: those that the scene says to ignore.
        apart_by_bounds: proven apart by where their bodies go, without a look at any tree.
        apart_by_trees: proven apart by their trees. (Not proven where motion is sampled.)
        in_contact: whose contact was found.
        unresolved: that a limit left open.
        later: not finished, as all that is asked was known before.
        box_tests: pairs of boxes tested.
        triangle_tests: pairs of triangles tested.
        exact_triangle_tests: those of them that exact arithmetic had to decide.
        pops: pairs taken from queues.
        image_tests: pairs of images tested, of bodies that move on a common screw.
        bodies: what of each body was used.
        seconds: s of wall time by stage.
    """

    pairs: int
    static: int
    ignored: int
    apart_by_bounds: int
    apart_by_trees: int
    in_contact: int
    unresolved: int
    later: int
    box_tests: int
    triangle_tests: int
    exact_triangle_tests: int
    pops: int
    image_tests: int
    bodies: tuple[BodyStats, ...]
    seconds: Mapping[str, float]
