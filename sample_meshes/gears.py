"""A gear and a pinion with involute flanks, 36 and 18 teeth of module 2 mm, in mesh."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from surfaces import Points, Surface, loft, polar, turn_angles, weld

MODULE = 2.0
PRESSURE_ANGLE = np.radians(20.0)
GEAR_TEETH, PINION_TEETH = 36, 18
AXIS_DISTANCE = MODULE * (GEAR_TEETH + PINION_TEETH) / 2.0
# Play along the pitch circles, half of it left by each wheel and half of it on either flank.
BACKLASH = 0.2
FLANK_STEPS, FILLET_STEPS = 9, 4


@dataclass(frozen=True)
class Ring:
    """A circle of a wheel's body; `points_to_one` points of the outline share one of its points."""

    radius: float
    half_width: float
    points_to_one: int


def _involute(angle: Points | float) -> Points | float:
    return np.tan(angle) - angle


def _half_tooth(teeth: int) -> tuple[Points, Points]:
    """Radii and angles from the middle of a gap up to, not including, the middle of the tooth."""
    pitch_radius = MODULE * teeth / 2.0
    base_radius = pitch_radius * np.cos(PRESSURE_ANGLE)
    root_radius, tip_radius = pitch_radius - 1.25 * MODULE, pitch_radius + MODULE
    half_at_pitch = (np.pi * MODULE - BACKLASH) / 2.0 / (2.0 * pitch_radius)
    half_at_base = half_at_pitch + _involute(PRESSURE_ANGLE)

    rolls = np.linspace(0.0, np.sqrt((tip_radius / base_radius) ** 2 - 1.0), FLANK_STEPS + 1)
    flank_radii = base_radius * np.sqrt(1.0 + rolls**2)
    flank_angles = half_at_base - _involute(np.arctan(rolls))

    # A Bezier curve of degree 2 rounds the corner between the root circle and the flank's foot.
    step = np.arange(FILLET_STEPS) / FILLET_STEPS
    fillet_radii = root_radius + step**2 * (base_radius - root_radius)
    fillet_angles = half_at_base + (1.0 - step) ** 2 * 0.25 * MODULE / root_radius

    radii = np.concatenate([[root_radius], fillet_radii, flank_radii])
    angles = np.concatenate([[np.pi / teeth], fillet_angles, flank_angles])
    return radii, -angles


def _outline(teeth: int, tip_radius: float) -> tuple[Points, Points]:
    """Radii and angles of all teeth, the first of them centred on angle 0."""
    radii, angles = _half_tooth(teeth)
    tooth_radii = np.concatenate([radii, [tip_radius], radii[:0:-1]])
    tooth_angles = np.concatenate([angles, [0.0], -angles[:0:-1]])
    pitches = 2.0 * np.pi * np.arange(teeth) / teeth
    return np.tile(tooth_radii, teeth), (pitches[:, None] + tooth_angles).ravel()


def _wheel(teeth: int, phase: float, half_width: float, body: list[Ring]) -> Surface:
    """A wheel from its teeth down to its bore, symmetric about the plane z = 0."""
    radii, angles = _outline(teeth, MODULE * (teeth / 2.0 + 1.0))
    angles += phase
    # Below the teeth the first ring keeps the outline's angles: fans would fold over on steep feet.
    foot, *rest = body
    upper = [polar(radii, angles, half_width), polar(foot.radius, angles, foot.half_width)]
    for ring in rest:
        ring_angles = angles[0] + turn_angles(len(angles) // ring.points_to_one)
        upper.append(polar(ring.radius, ring_angles, ring.half_width))
    lower = [points * np.array([1.0, 1.0, -1.0]) for points in upper]
    return weld([loft([lower[0], *upper, *lower[:0:-1]], closed=True)])


def gear() -> Surface:
    """Return the gear, its axis the z axis, a tooth pointing along x."""
    rim, web = Ring(30.5, 6.0, 1), Ring(29.5, 3.0, 3)
    hub = [Ring(13.0, 3.0, 9), Ring(12.0, 8.0, 9), Ring(6.0, 8.0, 9)]
    return _wheel(GEAR_TEETH, 0.0, 6.0, [rim, web, *hub])


def pinion() -> Surface:
    """Return the pinion, its axis through (54, 0, 0), a gap towards the gear."""
    body = [Ring(13.0, 7.0, 1), Ring(4.0, 7.0, 9)]
    wheel = _wheel(PINION_TEETH, np.pi / PINION_TEETH, 7.0, body)
    return wheel.moved(AXIS_DISTANCE, 0.0, 0.0)
