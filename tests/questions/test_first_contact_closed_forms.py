from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from movers.answers import ask, assert_bracket, assert_coherent, assert_width, size
from scenes.planes import plane_time
from scenes.screw import ScrewScene, Z, all_scenes

from obbcli import Body, Mesh, Motion, Status, first_contact

SCENES = list(all_scenes())
CONTACTS = [scene for scene in SCENES if scene.status == "contact"]


def true_time(scene: ScrewScene) -> Fraction:
    return Fraction(*scene.time.as_integer_ratio())


def test_scenes_cover_every_status() -> None:
    assert {scene.status for scene in SCENES} == {"contact", "separated", "overlap_at_start"}


@pytest.mark.parametrize("scene", SCENES, ids=lambda scene: str(scene.name))
def test_closed_form_has_its_status(scene: ScrewScene) -> None:
    answer = ask(scene.a, scene.b, scene.duration)

    if scene.name == "vertex_stops_just_above" and answer.status is Status.CONTACT:
        # Half an ulp short of contact: rounding may forbid more than closeness.
        assert answer.evidence == "within_tolerance"
        assert answer.distance is not None
        assert answer.distance <= 1e-13 * size(scene.a, scene.b)
        return
    assert answer.status == scene.status


@pytest.mark.parametrize("scene", CONTACTS, ids=lambda scene: str(scene.name))
def test_closed_form_lies_in_the_bracket(scene: ScrewScene) -> None:
    answer = ask(scene.a, scene.b, scene.duration)

    assert_bracket(answer, true_time(scene), true_time(scene))


@pytest.mark.parametrize("scene", SCENES, ids=lambda scene: str(scene.name))
def test_closed_form_has_evidence(scene: ScrewScene) -> None:
    answer = ask(scene.a, scene.b, scene.duration)

    assert_coherent(answer, scene.a, scene.b, scene.duration)


@pytest.mark.parametrize("tolerance", [1e-2, 1e-5, 1e-12])
@pytest.mark.parametrize("name", ["rod_against_wall", "edge_lands_skew", "rod_grazes_wall"])
def test_bracket_is_as_narrow_as_asked(name: str, tolerance: float) -> None:
    scene = next(one for one in SCENES if one.name == name)
    asked = tolerance * scene.duration

    answer = ask(scene.a, scene.b, scene.duration, time_tolerance=asked)

    assert_bracket(answer, true_time(scene), true_time(scene))
    assert_width(answer, scene.a, scene.b, asked)


def test_default_pivot_is_the_centroid_of_the_surface() -> None:
    scene = next(one for one in SCENES if one.name == "vertex_lands_skew")
    shift = np.array([0.5, 0.25, 0.0])
    moved = replace(scene.a, translation=shift, pivot=shift)
    time = plane_time(moved, -Z, 2.0, scene.duration)

    answer = ask(replace(moved, pivot=None), scene.b, scene.duration)

    assert time is not None
    assert answer.time == pytest.approx(float(time), abs=2e-9)


@pytest.mark.parametrize("exponent", [-54, -60, -63, -64, -80, -300, -1000])
@pytest.mark.parametrize("gap", [1.0, 2.0**-40, 2.0**80])
def test_times_just_after_a_power_of_two_have_a_double_above(exponent: int, gap: float) -> None:
    chased = Fraction(2) ** exponent
    time = 1 / (1 - chased)  # of a gap that is closed at the speed 1 - 2^exponent in its units
    corner = np.array([[0.0, 0, 0], [0, 1, 0], [0, 0, 1]])
    a = Body(Mesh(corner, [[0, 1, 2]]), motion=Motion([gap, 0, 0]))
    b = Mesh(corner + np.array([gap, 0, 0]), [[0, 1, 2]])
    answer = first_contact(a, Body(b, motion=Motion([gap * 2.0**exponent, 0, 0])), duration=2)

    assert answer.time_bounds is not None
    low, high = answer.time_bounds
    assert high is not None
    assert Fraction(low) < time < Fraction(high)
    assert high == np.nextafter(low, 2)
