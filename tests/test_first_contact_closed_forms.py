from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from screw_answers import ask, assert_bracket, assert_coherent, assert_width, size
from screw_planes import plane_time
from screw_scenes import ScrewScene, Z, all_scenes

from obbcli import Status

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
