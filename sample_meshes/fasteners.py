"""A bolt and a nut, M16 x 2, whose right-handed threads run with play on all sides."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from surfaces import (
    Face,
    Points,
    Surface,
    cap,
    circle,
    loft,
    polar,
    turn_angles,
    weld,
)

PITCH = 2.0
STEPS = 72
# Flanks of a metric thread stand at 30 degrees to the plane across the axis.
FLANK_SLOPE = np.tan(np.radians(30.0))
RUN_OUT_TURNS = 0.6
HEX_INRADIUS = 12.0
# The middle of the bolt's ridge lies at z = RIDGE_PHASE + PITCH * (turns about the axis).
RIDGE_PHASE = 0.5
NUT_BOTTOM, NUT_TOP = 6.0, 19.0
BOLT_HEAD_BOTTOM, BOLT_END = -10.0, 31.0


@dataclass(frozen=True)
class Thread:
    """A helical ridge on a cylinder (outwards, or inwards where the ridge has the smaller radius).

    Attributes:
        base_radius: the cylinder's radius, mm.
        ridge_radius: the radius at the ridge's flat top, mm.
        base_half_width: half the ridge's axial width at its foot, mm.
        ridge_half_width: half its axial width at its top, mm.
        middle: height of the ridge's middle at angle 0, first turn, mm.
        ridge_turns: length of the ridge in turns.
    """

    base_radius: float
    ridge_radius: float
    base_half_width: float
    ridge_half_width: float
    middle: float
    ridge_turns: int

    def point_columns(self) -> Points:
        """Return points (STEPS + 1, rows, 3); the last column is the first, four rows higher."""
        turns = np.arange(STEPS + 1) / STEPS
        angles = np.append(turn_angles(STEPS), 0.0)
        foot, top = self.base_half_width, self.ridge_half_width
        columns = []
        for row in range(4 * self.ridge_turns + 1):
            along = row // 4 + turns
            ends = np.minimum(along, self.ridge_turns - along) / RUN_OUT_TURNS
            rise = np.clip(ends, 0.0, 1.0) if row % 4 in (1, 2) else np.zeros_like(turns)
            radii = self.base_radius + rise * (self.ridge_radius - self.base_radius)
            heights = self.middle + PITCH * along + (-foot, -top, top, foot)[row % 4]
            columns.append(polar(radii, angles, heights))
        return np.stack(columns, axis=1)


def _threaded(thread: Thread, below: Points, above: Points) -> Surface:
    """The threaded surface, outside of a rod, joined to plain rings below and above it."""
    columns = thread.point_columns()
    rows = columns.shape[1]
    points = np.concatenate([columns.reshape(-1, 3), below, above])
    first_below = (STEPS + 1) * rows
    first_above = first_below + STEPS
    faces: list[Face] = []
    for step in range(STEPS):
        left, right, after = step * rows, (step + 1) * rows, (step + 1) % STEPS
        faces += [(left + k, right + k, right + k + 1, left + k + 1) for k in range(rows - 1)]
        if after:
            faces.append((first_below + step, first_below + after, right, left))
        if step:
            ring = (first_above + after, first_above + step)
            faces.append((left + rows - 1, right + rows - 1, *ring))
    # At angle 0 the helix has climbed by one pitch: fans close the steps at the two ends.
    last, end = (STEPS - 1) * rows, STEPS * rows
    step_up = [first_below + STEPS - 1, first_below, *range(4), end]
    faces += [(last, a, b) for a, b in pairwise(step_up)]
    next_to_end = 2 * rows - 1
    step_down = [first_above + 1, first_above, *range(end + rows - 1, end + rows - 6, -1)]
    faces += [(next_to_end, a, b) for a, b in pairwise(step_down)]
    return Surface(points, faces)


def _hexagon(z: float, chamfer_to: float | None = None) -> Points:
    """A hexagonal ring at height z, its corners chamfered by 30 degrees towards `chamfer_to`."""
    angles = turn_angles(STEPS)
    from_side = np.abs((np.arange(STEPS) % (STEPS // 6)) / (STEPS // 6) - 0.5) * np.pi / 3.0
    radii = HEX_INRADIUS / np.cos(from_side)
    if chamfer_to is None:
        return polar(radii, angles, z)
    drop = (radii - 0.95 * HEX_INRADIUS) * FLANK_SLOPE
    return polar(radii, angles, z + np.copysign(drop, chamfer_to - z))


def bolt() -> Surface:
    """Return the bolt: its axis the z axis, the head's bearing face at z = 0, the thread above."""
    core, crest, crest_half_width = 6.8, 8.0, PITCH / 16.0
    foot_half_width = crest_half_width + (crest - core) * FLANK_SLOPE
    thread = Thread(core, crest, foot_half_width, crest_half_width, RIDGE_PHASE + PITCH, 13)
    chamfer_ring = circle(0.95 * HEX_INRADIUS, BOLT_HEAD_BOTTOM, STEPS)
    neck, shoulder = circle(core, 0.0, STEPS), circle(core, BOLT_END - 0.6, STEPS)
    tip = circle(core - 0.6, BOLT_END, STEPS)
    head = loft([chamfer_ring, _hexagon(BOLT_HEAD_BOTTOM, 0.0), _hexagon(0.0), neck])
    shaft = _threaded(thread, neck, shoulder)
    return weld([cap(chamfer_ring).reversed(), head, shaft, loft([shoulder, tip]), cap(tip)])


def nut() -> Surface:
    """Return the nut on the bolt, three turns above the head's bearing face."""
    core, groove = 7.0, 8.15
    # Bolt flanks lie (8 - r) tan 30 degrees from the crest; the nut's are 0.1 mm further on.
    half_gap_at_8 = PITCH / 16.0 + 0.1
    half_widths = [PITCH / 2 - half_gap_at_8 - (8.0 - r) * FLANK_SLOPE for r in (groove, core)]
    middle = RIDGE_PHASE + PITCH / 2.0 + 3.0 * PITCH
    thread = Thread(groove, core, half_widths[0], half_widths[1], middle, 5)
    bottom, top = circle(8.8, NUT_BOTTOM, STEPS), circle(8.8, NUT_TOP, STEPS)
    bottom_face, top_face = (circle(0.95 * HEX_INRADIUS, z, STEPS) for z in (NUT_BOTTOM, NUT_TOP))
    low, high = _hexagon(NUT_BOTTOM, NUT_TOP), _hexagon(NUT_TOP, NUT_BOTTOM)
    outside = loft([bottom, bottom_face, low, high, top_face, top])
    return weld([outside, _threaded(thread, bottom, top).reversed()])
