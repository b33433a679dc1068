"""Moving pairs whose first contact is known in closed form, shared by tests and benches.

Times are exact for the input as rounded: dyadic figures, or `plane_time` of the posed vertices.
Nothing here imports the package. `test_screw_scenes` checks what they claim by other means.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import mpmath
import numpy as np
from movers.meshes import box, cube, disc, octahedron, tetrahedron, tube
from oracles.screw import Mover
from scenes.pairs import random_rotation
from scenes.planes import DIGITS, plane_time

if TYPE_CHECKING:
    from collections.abc import Iterator

    from oracles.screw import Status

WALL = 8.0  # half the side of walls, which stand for planes
# More than 1e-10 of the size of any pair below: what a certified answer must still tell apart.
GAP = 2.0**-28
X, Y, Z = np.eye(3)


@dataclass(frozen=True, eq=False)
class ScrewScene:
    """Two moving meshes, how their question ends and when they first touch.

    Attributes:
        name: what happens.
        a, b: the bodies.
        duration: s.
        status: of the true answer.
        time: the first contact, exact or to 40 digits; None where there is none.
        instant: whether the contact lasts but an instant, so that nothing after it proves it.
        normal: of contact, from A to B, where B is a wall.
    """

    name: str
    a: Mover
    b: Mover
    duration: float
    status: Status
    time: Any = None
    instant: bool = False
    normal: Any = None

    @property
    def turns(self) -> float:
        """How often the faster body turns."""
        speed = max(float(np.linalg.norm(body.spin)) for body in (self.a, self.b))
        return speed * self.duration / (2 * math.pi)


def against_plane(
    name: str, body: Mover, normal: Any, level: float, duration: float, unit: float = 1.0
) -> ScrewScene:
    """Return a body moving towards a thick wall whose near side is `normal . x = level`."""
    axis = int(np.argmax(np.abs(normal)))
    # Of unequal sides, so that what lands in the middle misses the diagonals.
    low, high = np.full(3, -WALL * unit), (WALL + np.arange(3.0)) * unit
    low[axis], high[axis] = sorted((normal[axis] * level, normal[axis] * (level + unit)))
    time = plane_time(body, normal, level, duration)
    status: Status = "separated" if time is None else "contact"
    if time == 0:
        status = "overlap_at_start"
    wall = Mover(*box(low, high))
    return ScrewScene(name, body, wall, duration, status, time, time == duration, normal)


def rod(length: float = 2.0, half: float = 0.0625) -> Any:
    """Return a square rod along x from 0."""
    return box((0.0, -half, -half), (length, half, half))


def diamond() -> Any:
    """Return a square bar along x that stands on an edge: corners at distance 1 from its axis."""
    corners = [
        (x, *yz) for x in (-2.0, 2.0) for yz in ((0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0))
    ]
    ring = [(i, (i + 1) % 4) for i in range(4)]
    faces = [face for i, j in ring for face in ((i, j, 4 + j), (i, 4 + j, 4 + i))]
    faces += [(0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7)]
    return np.array(corners), np.array(faces)


def swinging() -> Iterator[ScrewScene]:
    """Yield rods, wheels and the like that reach a wall by turning."""
    yield against_plane("rod_against_wall", Mover(*rod(), spin=Z), Y, 1.0, 2.0)
    yield against_plane("rod_too_short_for_wall", Mover(*rod(), spin=Z), Y, 2.25, 7.0)
    tip = math.hypot(2.0, 0.0625)
    near, far = tip - GAP, tip + GAP
    yield against_plane("rod_grazes_wall", Mover(*rod(), spin=Z), Y, near, 2.0)
    yield against_plane("rod_just_misses_wall", Mover(*rod(), spin=Z), Y, far, 2.0)
    yield against_plane("rod_just_misses_wall_often", Mover(*rod(), spin=20 * Z), Y, far, 2.0)
    skew = np.array([0.25, 0.5, 1.0])
    yield against_plane(
        "rod_on_skew_axis", Mover(*rod(), spin=skew, pivot=(0.5, 0, 0)), Y, 1.0, 4.0
    )
    wheel = Mover(*disc(12, 1.0, -0.25, 0.25), velocity=(3.0, -0.125, 0.0), spin=-3 * Z)
    yield against_plane("wheel_rolls_down_to_plane", wheel, -Y, 1.03125, 4.0)
    yield against_plane("wheel_slides_along_plane", replace(wheel, velocity=X), -Y, 1.0 + GAP, 4.0)
    yield against_plane(
        "wheel_brakes_on_plane", replace(wheel, velocity=-Y, spin=3 * Z), -Y, 1.5, 4.0
    )


def landing() -> Iterator[ScrewScene]:
    """Yield cubes, bars and octahedra that land flat, on an edge, on a vertex, straight or not."""
    shapes = {"face": cube(), "edge": diamond(), "vertex": octahedron()}
    spins = {
        "straight": 0 * Z,
        "spinning_upright": 2 * Z,
        "tumbling": 0.375 * X,
        "skew": np.array([0.25, 0.125, -0.5]),
    }
    for shape, mesh in shapes.items():
        for spin, w in spins.items():
            body = Mover(*mesh, velocity=-2 * Z, spin=w)
            yield against_plane(f"{shape}_lands_{spin}", body, -Z, 2.0, 1.0)
    body = Mover(*octahedron(), velocity=(1.0, 0.0, -2.0), spin=3 * Z, pivot=(0.5, 0.25, 0.0))
    yield against_plane("vertex_lands_at_the_very_end", body, -Z, 2.0, 0.5)
    short = math.nextafter(0.5, 0)
    yield against_plane("vertex_stops_just_above", body, -Z, 2.0, short)
    facets = disc(24, 1.0, -1.0, 1.0)
    ball = Mover(*facets, velocity=(0.25, 0.5, -1.0), spin=(0.5, -0.25, 0.75))
    yield against_plane("drum_lands_skew", ball, -Z, 2.0, 2.0)


def screws() -> Iterator[ScrewScene]:
    """Yield bodies on helices: a blade that closes on a fin in the plane of its axis, and a pin."""
    # The blade lies in y = 0, x > 0; the fin in x = 0, y > 0: they meet flat at a quarter turn.
    blade = np.array([(0.5, 0.0, 0.0), (1.5, 0.0, 0.0), (1.0, 0.0, 0.5)]), np.array([(0, 1, 2)])
    with mpmath.workdps(DIGITS):
        quarter = mpmath.pi / 2
    for name, pitch, low, meets in (
        ("blade_screws_into_fin", 1.0, 1.5, True),
        ("blade_screws_past_fin", -1.0, 1.5, False),
        ("blade_screws_under_fin", 1.0, 2.25, False),
    ):
        fin = np.array([(0.0, 0.25, low), (0.0, 2.0, low), (0.0, 1.0, low + 0.5)]), blade[1]
        body = Mover(*blade, velocity=pitch * Z, spin=Z)
        status: Status = "contact" if meets else "separated"
        time = quarter if meets else None
        yield ScrewScene(name, body, Mover(*fin), 2.0, status, time, meets)
    pin = Mover(*box((1.0, -0.25, -0.25), (1.5, 0.25, 0.25)), velocity=0.5 * Z, spin=4 * Z)
    yield against_plane("pin_screws_into_plate", pin, Z, 1.25, 4.0)
    yield against_plane("pin_screws_short_of_plate", pin, Z, 2.25 + GAP, 4.0)
    tip = replace(pin, velocity=(0.5, 0.25, 0.125), spin=(4.0, 2.0, 1.0))
    yield against_plane("pin_screws_into_wall_askew", tip, X, 3.0, 4.0)


def holes() -> Iterator[ScrewScene]:
    """Yield square bars that turn inside a square hole: they pass if their diagonal does."""
    bar = cube(1.0)
    for name, side, spin in (
        ("bar_jams_in_hole", 1.25, Z),
        ("bar_jams_late_in_hole", 1.41421, Z),
        ("bar_just_spins_free", 2**0.5 + GAP, Z),
        ("bar_spins_free_often", 2**0.5 + 1e-6, 30 * Z),
    ):
        ring = Mover(*tube(side, side + 1, -0.5, 0.5))
        time = None
        if side < 2**0.5:
            with mpmath.workdps(DIGITS):
                time = mpmath.asin(mpmath.mpf(side) / mpmath.sqrt(2)) - mpmath.pi / 4
        status: Status = "contact" if time is not None else "separated"
        yield ScrewScene(name, Mover(*bar, spin=spin), ring, 2.0, status, time)


def pairs_of_movers() -> Iterator[ScrewScene]:
    """Yield pairs in which both move."""
    # Mirror images meet in the mirror x = 1.5, when one of them reaches it.
    left = Mover(*rod(), rotation=_turned_back(), spin=Z)
    flip = np.array([-1.0, 1.0, 1.0])
    points = flip * left.start + np.array([3.0, 0.0, 0.0])
    right = Mover(points, left.faces[:, ::-1], spin=-Z, pivot=(3.0, 0.0, 0.0))
    time = plane_time(left, X, 1.5, 3.0)
    yield ScrewScene("counter_rotating_rods", left, right, 3.0, "contact", time)
    apart = replace(right, vertices=points + X, pivot=(4.25, 0.0, 0.0))
    yield ScrewScene(
        "counter_rotating_rods_apart",
        left,
        replace(apart, vertices=points + 1.25 * X),
        3.0,
        "separated",
    )
    motion: dict[str, Any] = {
        "velocity": (1.0, 2.0, -3.0),
        "spin": (3.0, -5.0, 7.0),
        "pivot": (0.5, 1.5, 0.25),
    }
    one = Mover(*cube(), **motion)
    for gap in (0.5, 2.0**-30):
        two = Mover(cube()[0] + (2 + gap) * X, cube()[1], **motion)
        yield ScrewScene(f"same_motion_gap_{gap:g}", one, two, 3.0, "separated")
    touching = Mover(cube()[0] + 2 * X, cube()[1], velocity=X, spin=X)
    yield ScrewScene(
        "touching_at_start_parting", Mover(*cube()), touching, 1.0, "overlap_at_start", Fraction(0)
    )
    point = Mover(octahedron()[0] + 2 * X, octahedron()[1], spin=Z, pivot=(2.0, 0.0, 0.0))
    yield ScrewScene(
        "vertices_touch_at_start", Mover(*octahedron()), point, 1.0, "overlap_at_start", Fraction(0)
    )
    inner = Mover(*tetrahedron(), spin=(1.0, 2.0, 3.0))
    yield ScrewScene(
        "tumbling_inside_a_box", inner, Mover(*cube(2.0), velocity=0.125 * X), 2.0, "separated"
    )


def _turned_back() -> Any:
    """Return three quarters of a turn about z."""
    return np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])


def many_turns() -> Iterator[ScrewScene]:
    """Yield slow drifts of fast spinners; turn k is the first to reach the wall."""
    for turns, most in ((3, 10), (100, 150), (1000, 1500)):
        drift = 1.0 / turns / (2 * math.pi)
        body = Mover(*tetrahedron(), velocity=drift * Y, spin=Z)
        duration = 2 * math.pi * most
        yield against_plane(f"contact_in_turn_{turns}", body, Y, 2.5, duration)
    fast = Mover(*disc(6, 1.0, -0.5, 0.5), velocity=2.0**-10 * Z, spin=600 * Z)
    yield against_plane("drift_along_the_axis_1e5_turns", fast, Z, 1.5, 2048.0)
    still = replace(fast, velocity=0 * Z, spin=6283.0 * Z)
    yield against_plane("slab_beside_plate_1e6_turns", still, Z, 0.5 + GAP, 1000.0)
    yield against_plane("own_axis_beside_wall", replace(still, spin=64 * Z), Y, 1 + GAP, 8.0)
    early = Mover(*rod(), spin=6283.0 * Z)
    yield against_plane("early_contact_of_1e6_turns", early, Y, 1.0, 1000.0)


def extremes() -> Iterator[ScrewScene]:
    """Yield a few of the above very small, very large and far from the origin."""
    chosen = {scene.name: scene for scene in (*swinging(), *screws())}
    for name in ("rod_against_wall", "rod_grazes_wall", "blade_screws_into_fin"):
        for power in (-40, 40):
            yield scaled(chosen[name], power)
    # Exact there as well: what is shifted lies on a grid of 2**-5.
    for name in ("rod_against_wall", "rod_on_skew_axis", "pin_screws_into_plate"):
        yield shifted(chosen[name], np.array([2.0**27, -(2.0**26), 2.0**27]))
    for unit in (1e-12, 1e12):
        body = Mover(rod()[0] * unit, rod()[1], spin=Z)
        yield against_plane(f"rod_of_{unit:g}", body, Y, unit, 2.0, unit)
        body = replace(body, velocity=unit * Y, spin=X)
        yield against_plane(
            f"rod_of_{unit:g}_just_misses", body, Z, (0.0625 * 2**0.5 + GAP) * unit, 2.0, unit
        )
    off = np.array([1e8, -3e7, 2e8])
    body = Mover(*rod(), random_rotation(5), Z, Y, (1.0, 2.0, 3.0), off)
    yield against_plane("rod_about_a_pivot_1e8_away", body, X, 2e7, 1.0, 2.0**26)
    body = replace(body, translation=off, pivot=off + 0.3)
    yield _beside_wall_far_away(body)


def _beside_wall_far_away(body: Mover) -> ScrewScene:
    """Return a turning body at 1e8 and a wall there, all rounded to that grid."""
    wall = Mover(*box((-8.0, 2.0, -8.0), (8.0, 3.0, 8.0)), translation=body.translation)
    time = plane_time(body, Y, wall.start[:, 1].min(), 3.0)
    return ScrewScene("rod_and_wall_at_1e8", body, wall, 3.0, "contact", time)


def scaled(scene: ScrewScene, power: int) -> ScrewScene:
    """Return the scene with lengths times `2**power`; the time stays."""
    k = 2.0**power
    a, b = (
        replace(
            body,
            vertices=body.vertices * k,
            translation=np.multiply(body.translation, k),
            velocity=np.multiply(body.velocity, k),
            pivot=np.multiply(body.pivot, k),
        )
        for body in (scene.a, scene.b)
    )
    return replace(scene, name=f"{scene.name}_times_2^{power}", a=a, b=b)


def shifted(scene: ScrewScene, shift: Any) -> ScrewScene:
    """Return the scene elsewhere: the poses' translation and the pivots move by `shift`."""
    a, b = (
        replace(body, translation=body.translation + shift, pivot=body.pivot + shift)
        for body in (scene.a, scene.b)
    )
    return replace(scene, name=f"{scene.name}_far_away", a=a, b=b)


def all_scenes() -> Iterator[ScrewScene]:
    """Yield every scene."""
    for group in (swinging, landing, screws, holes, pairs_of_movers, many_turns, extremes):
        yield from group()
