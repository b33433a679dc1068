"""Two moving bodies and their first contact: the start, the way there, and where they are then."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.answers.status import Status
from obbcli.mesh.measure import diagonal
from obbcli.motion.body import pose_at
from obbcli.view.marks import normal_mark, point_mark
from obbcli.view.picture import VIEWS, Lines, Picture, Surface, bounds_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.answers.contact import FirstContact
    from obbcli.motion.body import Body
    from obbcli.motion.pose import Pose
    from obbcli.tree.tree import ObbTree
    from obbcli.view.picture import Color

_COLORS: dict[str, Color] = {"A": (74, 134, 196), "B": (232, 150, 62)}
_TRIANGLE_COLORS: dict[str, Color] = {"A": (16, 42, 214), "B": (214, 30, 16)}
_START_OPACITY = 0.16
_GHOST_OPACITY = 0.24
# What is nearer to a point than this share of the picture's size does not hide it.
_TOUCHING = 1e-3
# Of a picture's size, so that its marks are made of numbers.
_LARGEST = 1e306


class Moment(NamedTuple):
    """What is drawn of two bodies.

    Attributes:
        time: s, when they are drawn in full: the first contact, or the end of what is proven free.
        ghost_times: s, when they are drawn faintly, from 0 on; empty where nothing happens before.
        moving: names of the bodies that move by then, which ghosts are drawn of.
    """

    time: float
    ghost_times: list[float]
    moving: list[str]


def moment_of(
    bodies: tuple[Body, Body], answer: FirstContact, duration: float, ghosts: int
) -> Moment:
    """Return what is drawn of an answer.

    Args:
        bodies: A and B.
        answer: about them.
        duration: s, as resolved.
        ghosts: how many are drawn between the start and the end of the way.
    """
    time = answer.time
    if answer.status is Status.SEPARATED or time is None:
        time = duration
    names = ("A", "B")
    moving = [
        n for n, body in zip(names, bodies, strict=True) if time > 0 and not body.motion.is_at_rest
    ]
    times = [time * k / (ghosts + 1) for k in range(ghosts + 1)] if moving else []
    return Moment(time, times, moving)


def contact_picture(
    bodies: tuple[Body, Body], answer: FirstContact, moment: Moment, title: str, zoom: float = 1.0
) -> Picture:
    """Return the picture of an answer.

    Args:
        bodies: A and B; their shapes are trees.
        answer: about them.
        moment: what is drawn of them.
        title: one line.
        zoom: how many times closer the picture will be looked at: marks keep their size in it.
    """
    parts: list[Surface | Lines] = []
    touched = {"A": answer.triangle_a, "B": answer.triangle_b}
    for name, body in zip(("A", "B"), bodies, strict=True):
        parts += _body_parts(name, body, touched[name], moment)
    low, high = bounds_of(parts)
    size = min(diagonal(np.stack([low, high])), _LARGEST) / zoom
    if answer.point is None:
        return Picture(title=title, parts=parts, focus=low / 2 + high / 2, direction=VIEWS[0])
    point = np.array(answer.point)
    direction = _clearest_view(parts, point, size)
    marks: list[Surface | Lines] = [point_mark(point, size)]
    if answer.normal is not None:
        marks.insert(0, normal_mark(point, np.array(answer.normal), size))
    return Picture(title=title, parts=parts + marks, focus=point, direction=direction)


def _body_parts(
    name: str, body: Body, touched: int | None, moment: Moment
) -> list[Surface | Lines]:
    """Return a body in full, with the triangle that touches apart, and its ghosts."""
    tree: ObbTree = body.shape  # type: ignore[assignment]
    mesh, color = tree.mesh, _COLORS[name]
    now = pose_at(body, moment.time, tree)
    rows = np.arange(len(mesh.triangles))
    rest = mesh.triangles if touched is None else mesh.triangles[rows != touched]
    parts: list[Surface | Lines] = []
    if len(rest):
        label = f"{name} at t = {moment.time:.6g} s"
        parts.append(
            Surface(name=label, vertices=mesh.vertices, triangles=rest, color=color, pose=now)
        )
    if touched is not None:
        parts += _triangle_parts(name, tree.triangle(touched), now)
    for time in moment.ghost_times if name in moment.moving else ():
        parts.append(
            Surface(
                name=f"{name} at t = {time:.6g} s",
                vertices=mesh.vertices,
                triangles=mesh.triangles,
                color=color,
                pose=pose_at(body, time, tree),
                opacity=_GHOST_OPACITY if time else _START_OPACITY,
            )
        )
    return parts


def _triangle_parts(name: str, corners: NDArray[np.float64], pose: Pose) -> list[Surface | Lines]:
    """Return a triangle and its outline, which shows through what is before it."""
    color = _TRIANGLE_COLORS[name]
    one = np.arange(3)[None]
    sides = np.array([(0, 1), (1, 2), (2, 0)])
    label = f"triangle of {name}"
    return [
        Surface(name=label, vertices=corners, triangles=one, color=color, pose=pose),
        Lines(
            name=f"outline of the {label}",
            vertices=pose.apply(corners),
            segments=sides,
            color=color,
            is_mark=True,
        ),
    ]


def _clearest_view(
    parts: list[Surface | Lines], point: NDArray[np.float64], size: float
) -> NDArray[np.float64]:
    """Return the direction from which least stands before a point: of several, the first."""
    corners = np.concatenate(
        [p.world()[p.triangles] for p in parts if isinstance(p, Surface) and p.opacity == 1]
    )
    around = (corners - point) / (size or 1.0)
    hidden = [_crossings(around, view) for view in VIEWS]
    direction: NDArray[np.float64] = VIEWS[int(np.argmin(hidden))]
    return direction


def _crossings(corners: NDArray[np.float64], ray: NDArray[np.float64]) -> int:
    """Return how many triangles a ray from near the origin meets. Moeller, Trumbore 1997."""
    a = corners[:, 0]
    u, v = corners[:, 1] - a, corners[:, 2] - a
    with np.errstate(all="ignore"):
        p = np.cross(ray, v)
        inverse = 1.0 / np.einsum("ij,ij->i", u, p)
        s = -np.einsum("ij,ij->i", a, p) * inverse
        q = np.cross(-a, u)
        t = q @ ray * inverse
        along = np.einsum("ij,ij->i", v, q) * inverse
        meets = (s >= 0) & (t >= 0) & (s + t <= 1) & (along > _TOUCHING)
    return int(np.count_nonzero(meets))
