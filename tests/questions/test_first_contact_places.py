"""Where first contacts are, how narrow their brackets, and contacts right after the start."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from movers.answers import ask, assert_bracket, assert_coherent, assert_place, assert_width, bounds
from movers.cases import foreign_mover, rigid_mover
from movers.meshes import cube
from movers.random_pairs import KINDS, Kind, random_pair
from oracles.screw import Mover, screw_first_contact
from scenes import cases
from scenes.planes import plane_time
from scenes.screw import ScrewScene, X, Y, Z, against_plane, all_scenes, rod

from obbcli import Status

SCENES = {scene.name: scene for scene in all_scenes()}
CONTACTS = [scene for scene in SCENES.values() if scene.status == "contact"]
NORMAL_TOLERANCE = 1e-6


def names(scene: ScrewScene) -> str:
    return scene.name


@pytest.mark.parametrize("scene", CONTACTS, ids=names)
def test_closed_form_has_its_place(scene: ScrewScene) -> None:
    answer = ask(scene.a, scene.b, scene.duration)

    assert_place(answer, scene.a, scene.b)


# The rods first touch in a pair that grazes along an edge: rounding leaves it within tolerance.
PROVEN = [scene for scene in CONTACTS if scene.name != "counter_rotating_rods"]


@pytest.mark.parametrize("scene", PROVEN, ids=names)
def test_closed_form_has_a_narrow_bracket_with_proof(scene: ScrewScene) -> None:
    answer = ask(scene.a, scene.b, scene.duration)

    assert_width(answer, scene.a, scene.b, 1e-9 * scene.duration)
    # In 1e-9 of the duration, what grazes goes no deeper than positions round.
    if not scene.instant and "grazes" not in scene.name:
        assert answer.evidence == "intersecting"


@pytest.mark.parametrize("scene", [one for one in CONTACTS if one.normal is not None], ids=names)
def test_contact_with_a_wall_has_its_normal(scene: ScrewScene) -> None:
    answer = ask(scene.a, scene.b, scene.duration)

    assert answer.normal == pytest.approx(scene.normal, abs=NORMAL_TOLERANCE)
    assert answer.normal_b == pytest.approx(-scene.normal, abs=NORMAL_TOLERANCE)


@pytest.mark.parametrize(
    ("name", "features"),
    [
        ("face_lands_straight", {"face-face", "edge-face", "vertex-face"}),
        ("edge_lands_straight", {"edge-face", "vertex-face"}),
        ("vertex_lands_straight", {"vertex-face"}),
        ("vertex_lands_skew", {"vertex-face"}),
        ("rod_against_wall", {"edge-face", "vertex-face"}),
        ("vertices_touch_at_start", {"vertex-vertex"}),
    ],
)
def test_contact_names_what_meets(name: str, features: set[str]) -> None:
    scene = SCENES[name]

    answer = ask(scene.a, scene.b, scene.duration)

    # Of the triangles that touch at once, one may do so in less than the surfaces do.
    assert answer.feature in features


@pytest.mark.parametrize("case", cases.rigid_ccd(), ids=lambda case: str(case["name"]))
def test_certified_case_has_its_place(case: dict[str, Any]) -> None:
    a, b, duration = rigid_mover(case["A"]), rigid_mover(case["B"]), float(case["T"])

    answer = ask(a, b, duration)

    if answer.status is not Status.SEPARATED:
        assert_place(answer, a, b)
        assert_width(answer, a, b, 1e-9 * duration)


@pytest.mark.parametrize("case", cases.third_party_ccd(), ids=lambda case: str(case["id"]))
def test_case_of_another_project_has_its_place(case: dict[str, Any]) -> None:
    a, b = foreign_mover(case["body_a"]), foreign_mover(case["body_b"])

    answer = ask(a, b, float(case["t_max"]))

    if answer.status is not Status.SEPARATED:
        assert_place(answer, a, b)


@pytest.mark.parametrize("kind", KINDS)
def test_random_contact_has_its_place(kind: Kind) -> None:
    for seed in range(5000, 5100):
        a, b = random_pair(kind, seed)

        answer = ask(a, b, 1.0)

        if answer.status is Status.CONTACT:
            assert_place(answer, a, b)
            assert_width(answer, a, b, 1e-9)


def test_random_translations_meet_in_more_than_one_kind_of_feature() -> None:
    seen = {ask(*random_pair("translating", seed), 1.0).feature for seed in range(60)}

    # Vertices meet faces, and edges edges; what is a rarity must not be the rule.
    assert seen <= {None, "vertex-face", "face-vertex", "edge-edge"}
    assert len(seen) == 4


@pytest.mark.parametrize("spin", [0 * Z, Z, Y, X + Y + Z], ids=["straight", "flat", "edge", "skew"])
@pytest.mark.parametrize("power", [-20, -30, -36, -40, -44])
def test_contact_soon_after_the_start_is_no_overlap(power: int, spin: Any) -> None:
    vertices, faces = cube()
    body = Mover(vertices - (1 + 2.0**power) * Z, faces, velocity=Z, spin=spin)
    # About its own centre; the wall begins at z = 0.
    body = replace(body, pivot=-(1 + 2.0**power) * Z)
    scene = against_plane("soon", body, Z, 0.0, 1.0)

    answer = ask(scene.a, scene.b, 1.0)

    truth = screw_first_contact(scene.a, scene.b, 1.0)
    assert truth.status == "contact"
    assert_bracket(answer, truth.lo, truth.hi)
    assert_coherent(answer, scene.a, scene.b, 1.0)
    assert_width(answer, scene.a, scene.b, 1e-9)


@pytest.mark.parametrize("kind", KINDS)
def test_bodies_a_hair_apart_do_not_overlap(kind: Kind) -> None:
    # The pose just before a contact, as a start of its own: they meet at once, or part.
    met = 0
    for seed in range(6000, 6030):
        pair = random_pair(kind, seed)
        whole = screw_first_contact(*pair, 1.0)
        if whole.lo is None:
            continue
        earlier = float(whole.lo) - 10.0 ** -(3 + seed % 11)
        a, b = (started(body, earlier) for body in pair)
        truth = screw_first_contact(a, b, 1.0)

        answer = ask(a, b, 1.0)

        met += 1
        assert answer.status == truth.status, seed
        assert_coherent(answer, a, b, 1.0)
        if truth.status == "contact":
            assert_bracket(answer, truth.lo, truth.hi)
    assert met > 10


def started(body: Mover, time: float) -> Mover:
    """Return the body as it is at a time, rounded, to start from there."""
    vertices = np.array(body.at(time), dtype=np.float64)
    pivot = body.pivot + time * np.asarray(body.velocity)
    return Mover(vertices, body.faces, velocity=body.velocity, spin=body.spin, pivot=pivot)


@pytest.mark.parametrize("clearance", [0.25, 1e-3, 1e-9])
@pytest.mark.parametrize(
    "spin", [0 * Z, Z, np.array([0.25, 0.5, 1.0])], ids=["straight", "flat", "skew"]
)
def test_clearance_is_reached_when_the_wall_would_be_that_much_nearer(
    clearance: float, spin: np.ndarray
) -> None:
    body = Mover(*rod(), velocity=0.5 * Y, spin=spin)
    scene = against_plane("clearance", body, Y, 1.0, 2.0)
    time = plane_time(body, Y, Fraction(1) - Fraction(clearance), 2.0)
    assert time is not None

    answer = ask(scene.a, scene.b, 2.0, clearance=clearance)

    assert answer.status is Status.CONTACT
    lo, hi = bounds(answer)
    assert lo <= Fraction(*time.as_integer_ratio())
    assert hi - lo <= Fraction(2, 10**9)
    assert float(hi) == pytest.approx(float(time), abs=1e-8)
