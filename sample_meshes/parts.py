"""Chain links, a robot arm with its gripper and workpiece, a thin housing with its board."""

from __future__ import annotations

import numpy as np
from surfaces import (
    Points,
    Surface,
    capped_loft,
    circle,
    loft,
    polar,
    turn_angles,
    weld,
)

LINK_STRAIGHT, LINK_BEND, LINK_WIRE = 9.0, 8.0, 2.5
WRIST_X = 120.0
CUT_POINTS = 8
WALL, BOARD_PLAY = 0.2, 0.05


def chain_link() -> Surface:
    """Return a chain link of round wire around the origin, long in x, lying in the xy plane."""
    arc = np.linspace(-0.5, 0.5, 17) * np.pi
    right = np.stack([LINK_STRAIGHT + LINK_BEND * np.cos(arc), LINK_BEND * np.sin(arc)], axis=1)
    tops = np.linspace(0.5, -0.5, 4)[1:-1] * 2.0 * LINK_STRAIGHT
    straight = np.stack([tops, np.full_like(tops, LINK_BEND)], axis=1)
    core = np.concatenate([right, straight])
    outward = np.concatenate([np.stack([np.cos(arc), np.sin(arc)], axis=1), [[0.0, 1.0]] * 2])
    rings = []
    for (x, y), (nx, ny) in zip([*core, *-core], [*outward, *-outward], strict=True):
        wire = polar(LINK_WIRE, turn_angles(16), 0.0)
        rings.append(np.stack([x + wire[:, 0] * nx, y + wire[:, 0] * ny, -wire[:, 1]], axis=1))
    return weld([loft(rings, closed=True)])


def next_chain_link() -> Surface:
    """Return the next link: a quarter turn about the chain's axis, 27 mm on, 2 mm of slack."""
    link = chain_link()
    turned = link.points[:, [0, 2, 1]] * np.array([1.0, -1.0, 1.0])
    return weld([Surface(turned, link.faces).moved(27.0, 0.0, 0.0)])


def robot_link() -> Surface:
    """Return an arm between two bored bosses: base axis the z axis, wrist axis through x = 120."""
    base, wrist, middle = 30.0, 22.0, 60.0
    lean = np.arccos((base - wrist) / WRIST_X)
    share = (middle - base * np.cos(lean)) / (WRIST_X + (wrist - base) * np.cos(lean))
    half_width = base * np.sin(lean) + share * (wrist - base) * np.sin(lean)
    heights = np.linspace(-half_width, half_width, CUT_POINTS)
    cut = np.stack([np.full(CUT_POINTS, middle), heights], axis=1)
    base_arc = polar(base, np.linspace(lean, 2.0 * np.pi - lean, 33), 0.0)[:, :2]
    wrist_arc = polar(wrist, np.linspace(-lean, lean, 25), 0.0)[:, :2]
    wrist_arc[:, 0] += WRIST_X
    ends = (
        (cut, base_arc, 0.0, base - 6.0, 12.0),
        (cut[::-1], wrist_arc, WRIST_X, wrist - 5.0, 8.0),
    )
    halves = []
    for seam, arc, axis_x, boss, bore in ends:
        sides = [_between(seam[-1], arc[0], 8), _between(arc[-1], seam[0], 8)]
        outline = np.concatenate([seam, sides[0], arc, sides[1]])
        halves.append(_half_arm(outline, axis_x, boss, bore))
    return weld(halves)


def _between(start: Points, end: Points, steps: int) -> Points:
    """Evenly spaced points between two points, the ends left out."""
    return start + (np.arange(1, steps) / steps)[:, None] * (end - start)


def _half_arm(outline: Points, axis_x: float, boss: float, bore: float) -> Surface:
    """One end of the arm, cut open along the outline's first CUT_POINTS points."""
    angles = np.arctan2(outline[:, 1], outline[:, 0] - axis_x)
    upper = [np.concatenate([outline, np.full((len(outline), 1), 108.0)], axis=1)]
    for radius, z in ((boss + 1.0, 108.0), (boss, 112.0), (bore, 112.0)):
        upper.append(polar(radius, angles, z) + np.array([axis_x, 0.0, 0.0]))
    lower = [ring * np.array([1.0, 1.0, -1.0]) + np.array([0.0, 0.0, 200.0]) for ring in upper]
    skin = loft([*upper, *lower[::-1]])
    wall = loft([lower[0], upper[0]])
    return weld([skin, Surface(wall.points, wall.faces[CUT_POINTS - 1 :])])


def _block(half_x: float, half_y: float, corner: float, z: float) -> Points:
    """A ring around a rectangle with cut corners."""
    x, y = half_x - corner, half_y - corner
    corners = [(half_x, y), (x, half_y), (-x, half_y), (-half_x, y)]
    corners += [(-a, -b) for a, b in corners]
    return np.array([(a, b, z) for a, b in corners])


def palm_housing() -> Surface:
    """Return the gripper's palm about its own axis, the z axis: a block with a neck on top."""
    sizes = [(18.0, 33.0, 3.0, 64.0), (20.0, 35.0, 5.0, 66.0), (20.0, 35.0, 5.0, 80.0)]
    sizes += [(12.0, 12.0, 4.0, 80.0), (12.0, 12.0, 4.0, 87.5)]
    return capped_loft([_block(*size) for size in sizes])


def palm_rail() -> Surface:
    """Return one of the palm's two rails, the one at positive x, about the palm's axis."""
    rail = capped_loft([_block(2.0, 32.0, 0.5, 63.0), _block(2.0, 32.0, 0.5, 65.0)])
    return rail.moved(15.0, 0.0, 0.0)


def finger() -> Surface:
    """Return the finger at positive y: ribs towards the workpiece, 15 mm from the wrist's axis."""
    ribs = [(z, 15.0 if i % 2 == 0 else 15.8) for i, z in enumerate(np.linspace(4.0, 28.0, 13))]
    foot = [(32.0, 18.0), (48.0, 22.0), (54.0, 22.0), (54.5, 14.0), (62.5, 14.0)]
    inside = [(2.0, 15.5), *ribs, *foot]
    rings = []
    for z, inner in inside:
        outer = min(21.0 + 0.2 * max(z - 2.0, 0.0), 30.0)
        half_x = 9.0 if z > 54.0 else 6.0
        ring = _block(half_x, (outer - inner) / 2.0, 0.6, z)
        rings.append(ring + np.array([0.0, (inner + outer) / 2.0, 0.0]))
    return capped_loft(rings).moved(WRIST_X, 0.0, 0.0)


def opposite_finger() -> Surface:
    """Return the finger at negative y: the other one turned by half a turn about the wrist."""
    return finger().moved(-WRIST_X, 0.0, 0.0).turned_over().moved(WRIST_X, 0.0, 0.0)


def workpiece() -> dict[str, Surface]:
    """Return a stepped pin below the wrist and the pallet it stands on."""
    profile = [(9.0, 0.0), (10.0, 1.0), (10.0, 40.0), (6.0, 40.0), (6.0, 48.0), (5.0, 49.0)]
    pin = capped_loft([circle(radius, z, 24) for radius, z in profile], flat=True)
    sizes = [(50.0, 50.0, 8.0, -12.0), (50.0, 50.0, 8.0, 0.0)]
    pallet = capped_loft([_block(*size) for size in sizes], flat=True)
    return {"pin": pin.moved(WRIST_X, 0.0, 0.0), "pallet": pallet.moved(WRIST_X, 0.0, 0.0)}


def _tray_ring(inset: float, z: float) -> Points:
    """A ring around a rectangle of 60 by 40 mm with round corners, `inset` from its edge."""
    arc = np.linspace(0.0, 0.5, 7) * np.pi
    middles = ((25.0, 15.0), (-25.0, 15.0), (-25.0, -15.0), (25.0, -15.0))
    bends = [
        polar(5.0 - inset, arc + quarter * np.pi / 2.0, z) + np.array([x, y, 0.0])
        for quarter, (x, y) in enumerate(middles)
    ]
    ring = []
    for bend, following in zip(bends, [*bends[1:], bends[0]], strict=True):
        ring += [bend, _between(bend[-1], following[0], 4)]
    return np.concatenate(ring)


def housing() -> Surface:
    """Return an open tray with walls and floor of 0.2 mm, its underside at z = 0."""
    outer = [_tray_ring(0.0, z) for z in (0.0, 5.0, 10.0, 15.0, 20.0)]
    inner = [_tray_ring(WALL, z) for z in (20.0, 15.0, 10.0, 5.0, WALL)]
    return capped_loft([*outer, *inner])


def board() -> tuple[Points, list[list[int]]]:
    """Return points and hexahedra of a board in the housing, 0.05 mm from its walls and floor."""
    reach_x, reach_y = 30.0 - WALL - BOARD_PLAY, 20.0 - WALL - BOARD_PLAY
    x = np.concatenate([[-reach_x], np.linspace(-24.5, 24.5, 15), [reach_x]])
    y = np.concatenate([[-reach_y], np.linspace(-14.5, 14.5, 10), [reach_y]])
    z = [WALL + BOARD_PLAY, WALL + BOARD_PLAY + 1.6]
    ends_x, ends_y = (0, len(x) - 2), (0, len(y) - 2)
    cells = []
    for i in range(len(x) - 1):
        for j in range(len(y) - 1):
            # The tray's corners are round: the board does without its four corner cells.
            if i in ends_x and j in ends_y:
                continue
            cells.append([(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)])
    used = sorted({corner for cell in cells for corner in cell})
    index_of = {corner: index for index, corner in enumerate(used)}
    points = np.array([(x[i], y[j], level) for level in z for i, j in used])
    lower = [[index_of[corner] for corner in cell] for cell in cells]
    return points, [[*cell, *(len(used) + index for index in cell)] for cell in lower]
