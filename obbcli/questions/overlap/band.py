"""The touch band: how much of a gap and of an overlap is no more than rounding of the input."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from obbcli.answers.overlap import Band
from obbcli.arrays import as_floats
from obbcli.errors import MotionError
from obbcli.mesh.spacing import COARSEST

if TYPE_CHECKING:
    from collections.abc import Sequence

    from obbcli.mesh.spacing import Spacing
    from obbcli.motion.body import Body, Surface
    from obbcli.questions.pair_question import PairQuestion
    from obbcli.tree.tree import ObbTree

FLOOR = 1e-9
"""Of the pair's size: depths are not told apart below it."""
_SPACINGS = 4.0
_ASKED = "asked for"
# Of the largest coordinate of a body that is not placed: what spacings and sizes come to at most.
# Sizes are at most 2 sqrt(3) times that coordinate.
_MOST = _SPACINGS * COARSEST + 4.0 * FLOOR


def band_of(pair: PairQuestion, touch: Sequence[float] | None) -> Band:
    """Return what counts as touching.

    Two flush faces that were stored with rounded corners are at most the square root of 3 spacings
    apart or in each other: half a spacing in each of three coordinates, of either face. Four leave
    room for the rounding of their placement.

    Args:
        pair: the question.
        touch: gap and overlap, mesh units. None: the larger of 1e-9 sizes and four spacings of the
            coarser file's coordinates, plus both sags.

    Raises:
        MotionError: `touch` is not two finite numbers of at least 0.
    """
    size = pair_size(pair)
    slack = FLOOR * size
    if touch is not None:
        gap, overlap = checked_touch(touch)
        return Band(gap=gap, overlap=overlap, slack=slack, reason=_ASKED)
    coarser, spacing = max(
        zip("AB", map(_spacing, pair.bodies, pair.trees), strict=True),
        key=lambda named: named[1].value,
    )
    rounded = _SPACINGS * spacing.value
    told = "1e-9 of the size of the pair"
    if rounded > slack:
        told = f"4 spacings of the coordinates of {coarser} ({spacing.digits})"
    width = max(rounded, slack)
    sags = [tree.sag for tree in pair.trees]
    width += sum(sag or 0.0 for sag in sags)
    told += "".join(f", plus the sag of {x}" for x, sag in zip("AB", sags, strict=True) if sag)
    return Band(gap=width, overlap=width, slack=slack, reason=told)


def most_gap(placed: Sequence[tuple[Body, Surface]], touch: Sequence[float] | None) -> float:
    """Return what the gap of no two of some bodies exceeds, mesh units.

    No coordinate is looked at: the spacings that meshes tell are bounded by their own bounds.

    Args:
        placed: the bodies, each with its shape, of which bounds are known.
        touch: as `band_of` takes it.

    Raises:
        MotionError: as `band_of`.
    """
    if touch is not None:
        return checked_touch(touch)[0]
    sags = sorted(getattr(shape, "sag", None) or 0.0 for _, shape in placed)[-2:]
    largest = max((float(np.abs(shape.bounds).max()) for _, shape in placed), default=0.0)
    spacing = max((_placed_spacing(*one) for one in placed), default=0.0)
    return _MOST * largest + _SPACINGS * spacing + sum(sags)


def pair_size(pair: PairQuestion) -> float:
    """Return the larger diagonal of the boxes of A and B, unposed, mesh units."""
    return max(tree.size for tree in pair.trees)


def checked_touch(touch: Sequence[float]) -> tuple[float, float]:
    """Return a gap and an overlap as floats.

    Raises:
        MotionError: not two finite numbers of at least 0.
    """
    gap, overlap = as_floats(touch, (2,), "touch", MotionError).tolist()
    for name, value in (("gap", gap), ("overlap", overlap)):
        if value < 0:
            fault = f"has a negative {name}, {value!r}"
            raise MotionError("touch", fault, "use two numbers of at least 0: gap, overlap")
    return gap, overlap


def _spacing(body: Body, tree: ObbTree) -> Spacing:
    """Return how far apart the coordinates of a placed body are."""
    own = tree.mesh.coordinate_spacing
    if body.pose.is_identity:
        return own
    placed = _placed_spacing(body, tree)
    return own if own.value >= placed else own._replace(value=placed, digits="float64, placed")


def _placed_spacing(body: Body, surface: Surface) -> float:
    """Return how far apart doubles are at the largest coordinate that a placed body may have."""
    reach = float(np.abs(surface.bounds).max()) + float(np.abs(body.pose.translation).max())
    return float(np.spacing(reach))
