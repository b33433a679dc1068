"""What questions are asked about: a `Body`, a shape with its place and motion."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol, TypeAlias

from obbcli import kernels
from obbcli.motion.motion import Motion, refuse
from obbcli.motion.pose import Pose

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_AS_LOADED = Pose()
_AT_REST = Motion()


class Surface(Protocol):
    """What a body can be made of: an `ObbTree` or a `Mesh`."""

    @property
    def bounds(self) -> NDArray[np.float64]:
        """Lower and upper corner, (2, 3)."""

    @property
    def surface_centroid(self) -> NDArray[np.float64]:
        """The default pivot, unposed, (3,)."""


class Standing(Protocol):
    """A shape that says where it stands: a `Part` of a file."""

    @property
    def body(self) -> Body:
        """The shape at rest where it stands."""

    def posed(self, pose: Pose, *, is_absolute: bool) -> tuple[Surface, Pose]:
        """Return a surface and its pose, of which the shape is made that `pose` moves."""


# What bodies are made of, and what may be given for it.
BodyShape: TypeAlias = Surface | str | os.PathLike[str]
Shape: TypeAlias = BodyShape | Standing


@kernels.made_by_kernels
@dataclass(frozen=True, init=False, eq=False)
class Body(kernels.PlacedBody):
    """A shape with its place and motion; taken wherever a tree, a mesh, a part or a path is.

    Args:
        shape: an `ObbTree`, a `Mesh`, a `Part`, or the path of a mesh or tree file.
        pose: where it is at t = 0; that of the motion where this goes through poses. It moves a
            `Part` from where its file puts it.
        motion: how it moves from there.

    Raises:
        MotionError: an argument is of another kind, or a motion through poses comes with another
            pose.

    Example:
        >>> body = Body("sample_meshes/nut.obj", Pose(translation=[0, 0, 1]))
        >>> body.pose.translation.tolist()
        [0.0, 0.0, 1.0]
    """

    shape: BodyShape
    pose: Pose
    motion: Motion

    def __init__(self, shape: Shape, pose: Pose = _AS_LOADED, motion: Motion = _AT_REST) -> None:
        # Trees at poses do not come here: the kernels look at them. Trees belong to a layer above
        # this one, so a shape is told by its attributes; by those of its type, since to ask a tree
        # for its bounds may read a whole file.
        posed = None
        if not hasattr(type(shape), "bounds") and not isinstance(shape, (str, os.PathLike)):
            posed = getattr(shape, "posed", None)
            if posed is None:
                refuse("shape", shape, "pass an ObbTree, a Mesh, a Part or a path")
        if not isinstance(pose, Pose):
            refuse("pose", pose, "pass a Pose")
        if not isinstance(motion, Motion):
            refuse("motion", motion, "pass a Motion")
        pose = motion.first_pose(pose)
        if posed is not None:
            shape, pose = posed(pose, is_absolute=motion.places_mesh)
        self._hold(shape, pose, motion)


kernels.set_body_defaults(_AS_LOADED, _AT_REST)


def pivot_of(body: Body, surface: Surface) -> NDArray[np.float64]:
    """Return where a body's axis passes at t = 0, world coordinates, (3,).

    Args:
        body: whose motion has constant velocities, or none that needs a pivot.
        surface: what the body is made of; its centroid, posed, stands for a pivot not given.
    """
    if body.motion.pivot is not None:
        return body.motion.pivot
    pivot: NDArray[np.float64] = body.pose.apply(surface.surface_centroid[None])[0]
    return pivot


def missing_pivot(body: Body, surface: Surface) -> NDArray[np.float64] | None:
    """Return the pivot that a body's motion needs and does not have, (3,); None where it has all.

    The centroid of a surface costs a pass over all of it, which motions without need do not pay.
    """
    return pivot_of(body, surface) if body.motion.needs_pivot else None


def with_pivot(body: Body, surface: Surface) -> Motion:
    """Return a body's motion, about the same pivot whatever it is to move."""
    motion, pivot = body.motion, missing_pivot(body, surface)
    if pivot is None:
        return motion
    return Motion(motion.linear_velocity, motion.angular_velocity, pivot)


def pose_at(body: Body, time: float, surface: Surface) -> Pose:
    """Return where a body's mesh is at a time, as `Motion.pose_at`.

    Raises:
        MotionError: positions leave the range of double.
    """
    return body.motion.pose_at(time, body.pose, missing_pivot(body, surface))


def as_body(shape: Body | Shape) -> Body:
    """Return a `Body` as it is, and anything else at rest where its file put it.

    Raises:
        MotionError: neither a body nor a tree, a mesh, a part or a path.
    """
    if isinstance(shape, Body):
        return shape
    return Body(shape)
