"""Two bodies at t = 0, faint, and in full what they share."""

from __future__ import annotations

from typing import TYPE_CHECKING

from obbcli.view.picture import Picture, Surface, bounds_of

if TYPE_CHECKING:
    from obbcli.motion.body import Body
    from obbcli.tree.tree import ObbTree
    from obbcli.view.picture import Color, Lines
    from obbcli.view.shared_solid import SharedSolid

_COLORS: dict[str, Color] = {"A": (74, 134, 196), "B": (232, 150, 62)}
_OPACITY = 0.22


def overlap_picture(bodies: tuple[Body, Body], solid: SharedSolid | None, title: str) -> Picture:
    """Return the picture of what two bodies share.

    Args:
        bodies: A and B; their shapes are trees.
        solid: what they share; None: nothing.
        title: one line.
    """
    parts: list[Surface | Lines] = [
        _faint(name, body) for name, body in zip(("A", "B"), bodies, strict=True)
    ]
    shown = parts
    if solid is not None:
        # Seen through both, as what lies in a body would be hidden by it else.
        parts = [solid.surface(), *parts]
        shown = parts[:1]
    low, high = bounds_of(shown)
    return Picture(title=title, parts=parts, focus=low / 2 + high / 2)


def _faint(name: str, body: Body) -> Surface:
    tree: ObbTree = body.shape  # type: ignore[assignment]
    return Surface(
        name=name,
        vertices=tree.mesh.vertices,
        triangles=tree.mesh.triangles,
        color=_COLORS[name],
        pose=body.pose,
        opacity=_OPACITY,
    )
