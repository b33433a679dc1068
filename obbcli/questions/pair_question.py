"""`PairQuestion`: a question about two bodies, understood once and asked anywhere."""

from __future__ import annotations

import math
import os
from functools import partial
from time import perf_counter
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from obbcli.accuracy import DEFAULT_DURATION, TIME_TOLERANCE, Accuracy
from obbcli.errors import MeshError, MotionError
from obbcli.files import is_large_file
from obbcli.mesh import Mesh
from obbcli.motion.body import Body, as_body, pivot_of
from obbcli.threads import both
from obbcli.tree.tree import ObbTree, load_tree

if TYPE_CHECKING:
    from collections.abc import Iterable

    from obbcli.answers.clearance import LeastClearance
    from obbcli.answers.collision import Collision
    from obbcli.answers.contact import Contact, FirstContact
    from obbcli.answers.distance import Distance
    from obbcli.motion.body import Shape

# Triangles. The root box of so many takes some milliseconds.
_LARGE = 50_000
_EXACT = Accuracy()

_Answer = TypeVar("_Answer", "Collision", "Contact", "FirstContact", "Distance", "LeastClearance")
Trees = tuple[ObbTree, ObbTree]


class PairQuestion(NamedTuple):
    """What is asked about two bodies, with all defaults resolved; made by `of`.

    Attributes:
        bodies: A and B. A motion that is steady after all, such as a path of one pose, is replaced
            by the constant motion that it is.
        trees: the trees of A and B.
        duration: s; the closed interval [0, duration] is asked about.
        accuracy: what is asked of the answer.
        load_seconds: s of wall time that it took to read meshes and trees.
    """

    bodies: tuple[Body, Body]
    trees: Trees
    duration: float
    accuracy: Accuracy
    load_seconds: float = 0.0

    @classmethod
    def of(
        cls,
        a: Body | Shape,
        b: Body | Shape,
        duration: float | None = None,
        accuracy: Accuracy | None = None,
    ) -> PairQuestion:
        """Return the question about two shapes, which are read and given trees where need be.

        Args:
            a: a `Body`, an `ObbTree`, a `Mesh`, a `Part`, or the path of a mesh or tree file.
            b: as `a`.
            duration: s; None: as `duration_of` says.
            accuracy: None: the defaults.

        Raises:
            MotionError: the duration is negative or not finite, or a shape is of another kind.
            MeshError: a mesh cannot be read or is refused.
            TreeFileError: a tree file is damaged.
            OSError: a file cannot be read.
        """
        bodies = as_body(a), as_body(b)
        end = duration_of(duration, bodies)
        start = perf_counter()
        trees = trees_of(bodies)
        loaded = perf_counter() - start
        resolved = _resolved(bodies[0]), _resolved(bodies[1])
        return cls(resolved, trees, end, _EXACT if accuracy is None else accuracy, loaded)

    @property
    def is_steady(self) -> bool:
        """Whether both bodies have constant velocities."""
        a, b = self.bodies
        return a.motion.steady is not None and b.motion.steady is not None

    @property
    def is_at_rest(self) -> bool:
        """Whether the bodies are asked about at t = 0 alone, or neither moves."""
        a, b = self.bodies
        return self.duration == 0 or (a.motion.is_at_rest and b.motion.is_at_rest)

    @property
    def moves_nothing(self) -> bool:
        """Whether neither body, both of constant velocities, moves against the other."""
        if self.is_at_rest:
            return True
        (a, b), (tree_a, tree_b) = self.bodies, self.trees
        ma, mb = a.motion, b.motion
        if ma.is_at_rest or mb.is_at_rest or ma.velocities != mb.velocities:
            return False
        return not ma.is_turning or bool((pivot_of(a, tree_a) == pivot_of(b, tree_b)).all())

    def with_parts(
        self, answer: _Answer, triangles: tuple[int | None, int | None] | None
    ) -> _Answer:
        """Return a new answer, which names the selected parts that its triangles are of.

        Args:
            answer: as `with_parts` of this module has it.
            triangles: likewise.
        """
        return with_parts(self.trees, answer, triangles)

    @property
    def time_tolerance(self) -> float:
        """The width asked of a bracket, s."""
        return time_tolerance(self.accuracy, self.duration)


def _resolved(body: Body) -> Body:
    steady = body.motion.steady
    if steady is None or steady is body.motion:
        return body
    return Body(body.shape, body.pose, steady)


def with_parts(
    trees: Trees, answer: _Answer, triangles: tuple[int | None, int | None] | None
) -> _Answer:
    """Return a new answer, which names the selected parts that its triangles are of.

    Args:
        trees: of A and B.
        answer: that nobody else has yet.
        triangles: of A and B; None where it tells none.
    """
    a, b = trees
    if triangles is not None and (a.parts or b.parts):
        # Past the frozen dataclass, whose own way makes a second answer.
        fields = vars(answer)
        fields["part_a"] = a.part_of(triangles[0])
        fields["part_b"] = b.part_of(triangles[1])
    return answer


def check_units(units: dict[str, str | None]) -> None:
    """Refuse shapes that state different units of length.

    Args:
        units: what each shape states, by what errors call it.

    Raises:
        MeshError: two differ.
    """
    stated = [(name, unit) for name, unit in units.items() if unit is not None]
    for name, unit in stated[1:]:
        first, other = stated[0]
        if unit != other:
            fault = f"{first} is in {other}, {name} in {unit}"
            raise MeshError("unit", fault, "bring both to one: --unit U, or Mesh.in_unit")


def check_pair_units(trees: Trees) -> None:
    """Refuse trees of A and B that state different units of length.

    Raises:
        MeshError: they do.
    """
    unit, other = trees[0].unit, trees[1].unit
    # Compared in place: a question of some microseconds passes here.
    if unit != other and unit is not None and other is not None:
        check_units({"A": unit, "B": other})


def trees_of(bodies: tuple[Body, Body]) -> Trees:
    """Return the trees of two bodies, one for both where they share a shape.

    Two large shapes are read at the same time, and their root boxes made, which any question needs.

    Raises:
        MeshError: a mesh cannot be read or is refused, or the two state different units.
        TreeFileError: a tree file is damaged.
        OSError: a file cannot be read.
    """
    a, b = bodies[0].shape, bodies[1].shape
    if isinstance(a, ObbTree) and isinstance(b, ObbTree):
        trees = a, b
    else:
        if b is a:
            tree = _tree(a)
            trees = tree, tree
        else:
            at_once = _is_large(a) and _is_large(b)
            trees = both(partial(_tree, a, at_once), partial(_tree, b, at_once), at_once=at_once)
    check_pair_units(trees)
    return trees


def _tree(shape: Shape, has_root: bool = False) -> ObbTree:
    found = surface_of(shape)
    if not isinstance(found, Mesh):
        return found
    tree = ObbTree.build(found)
    return tree.with_root() if has_root else tree


def _is_large(shape: Shape) -> bool:
    """Return whether a thread pays for reading a shape and beginning its tree."""
    if isinstance(shape, Mesh):
        return len(shape.triangles) >= _LARGE
    return isinstance(shape, (str, os.PathLike)) and is_large_file(shape)


def surface_of(shape: Shape) -> Mesh | ObbTree:
    """Return the mesh or the tree that a shape is; a path's file is read.

    Raises:
        MeshError: a mesh cannot be read or is refused.
        TreeFileError: a tree file is damaged.
        OSError: a file cannot be read.
        MotionError: it is of another kind.
    """
    if isinstance(shape, (Mesh, ObbTree)):
        return shape
    if isinstance(shape, (str, os.PathLike)):
        return load_tree(shape)
    decoded = getattr(shape, "mesh", None)  # that of a part, which is decoded by this look
    if isinstance(decoded, Mesh):
        return decoded
    raise MotionError(
        "shape", f"is of type {type(shape).__name__}", "pass a tree, a mesh, a part or a path"
    )


def duration_of(duration: float | None, bodies: Iterable[Body]) -> float:
    """Return the end of the interval asked about, s.

    By default 0 where all bodies rest, the last time of a motion through poses, or else 1.

    Raises:
        MotionError: not a finite number of at least 0.
    """
    if duration is None:
        motions = [body.motion for body in bodies if not body.motion.is_at_rest]
        if not motions:
            return 0.0
        ends = (motion.ends_at for motion in motions)
        return max((end for end in ends if end is not None), default=DEFAULT_DURATION)
    try:
        seconds = float(duration)
    except (TypeError, ValueError) as fault:
        raise MotionError("duration", f"is {duration!r}", "use a number of seconds") from fault
    except OverflowError as fault:
        raise MotionError("duration", str(fault), "use a finite number of seconds") from fault
    if isinstance(duration, str) or not 0 <= seconds < math.inf:
        raise MotionError(
            "duration", f"is {duration!r}", "use a finite number of at least 0 seconds"
        )
    return seconds


def time_tolerance(accuracy: Accuracy, duration: float) -> float:
    """Return the width asked of a bracket, s."""
    asked = accuracy.time_tolerance
    return TIME_TOLERANCE * duration if asked is None else asked
