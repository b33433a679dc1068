"""Distance at rest over the pose classes: time and tests against python-fcl's and coal's."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import peers
from claims.distance import assert_bounds_hold
from harness import OURS, Row, alternate
from oracles.mesh import mesh_distance_squared
from scenes.pairs import pairs

import obbcli

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from scenes.pairs import Pair

SIZES = {10_000: 31, 100_000: 15}
QUICK_SIZES = {10_000: 9}
TRUTH_TRIANGLES = 320
SAMPLE_SECONDS = 0.0005
# Of the size: what a peer's distance may be off by, and what is called wrong.
PEER_ROUNDING = 1e-7


def run(quick: bool) -> Iterator[Row]:
    """Yield a row a size and pose class; every answer is checked."""
    check_against_truth()
    for triangles, rounds in (QUICK_SIZES if quick else SIZES).items():
        built: dict[tuple[str, int], Any] = {}
        for pair in pairs(triangles):
            bodies = _bodies(pair, built)
            calls: dict[str, Callable[[], object]] = {
                OURS: lambda bodies=bodies: obbcli.distance(*bodies),
                "python-fcl": _fcl(pair, built),
                "coal": _coal(pair, built),
            }
            answer = obbcli.distance(*bodies)
            stats = answer.stats
            notes: dict[str, dict[str, object]] = {
                OURS: {
                    "distance": answer.distance,
                    "box tests": stats.box_tests,
                    "triangle tests": stats.triangle_tests,
                    "pops": stats.pops,
                }
            }
            notes |= check_answers(pair, answer, {who: calls[who]() for who in set(calls) - {OURS}})
            timings = alternate(calls, rounds, SAMPLE_SECONDS)
            yield Row("distance", pair.name, len(pair.a.faces), timings, notes)


def check_against_truth() -> None:
    """Assert that the bounds hold what all pairs of triangles have in rational arithmetic."""
    for pair in pairs(TRUTH_TRIANGLES):
        square, _ = mesh_distance_squared(pair.a.vertices, pair.a.faces, pair.posed_b, pair.b.faces)
        assert_bounds_hold(obbcli.distance(*_bodies(pair, {})), square)


def check_answers(pair: Pair, ours: Any, others: dict[str, Any]) -> dict[str, dict[str, object]]:
    """Assert our answer by construction and python-fcl; return who is how far off, of the size."""
    low, high = ours.bounds
    assert 0 <= low <= high <= low + 1e-14 * pair.size, pair.name
    if pair.distance is not None:
        assert pair.distance[0] <= high, pair.name
        assert low <= pair.distance[1], pair.name
    if pair.touches is not None:
        assert (high == 0) == pair.touches, pair.name
    errors = {who: (max(0.0, said) - high) / pair.size for who, said in others.items()}
    assert abs(errors["python-fcl"]) <= PEER_ROUNDING, (pair.name, high, others)
    return {who: {"WRONG by": error} for who, error in errors.items() if abs(error) > PEER_ROUNDING}


def _model(one: Any, surface: Any, built: dict[tuple[str, int], Any]) -> Any:
    key = (one.name, id(surface))
    if key not in built:
        built[key] = one.build(surface)
    return built[key]


def _bodies(pair: Pair, built: dict[tuple[str, int], Any]) -> tuple[Any, Any]:
    a, b = (_model(peers.Obbtree(), surface, built) for surface in (pair.a, pair.b))
    return obbcli.Body(a), obbcli.Body(b, obbcli.Pose(pair.rotation, pair.translation))


def _fcl(pair: Pair, built: dict[tuple[str, int], Any]) -> Callable[[], float]:
    import fcl

    poses = fcl.Transform(), fcl.Transform(pair.rotation, pair.translation)
    a, b = (
        fcl.CollisionObject(_model(peers.Fcl(), surface, built), pose)
        for surface, pose in zip((pair.a, pair.b), poses, strict=True)
    )
    request = fcl.DistanceRequest()
    return lambda: float(fcl.distance(a, b, request, fcl.DistanceResult()))


def _coal(pair: Pair, built: dict[tuple[str, int], Any]) -> Callable[[], float]:
    """Return coal's question; its trees for distances are boxes with swept spheres."""
    import coal

    a, b = (_model(SweptSpheres(), surface, built) for surface in (pair.a, pair.b))
    poses = coal.Transform3s(), coal.Transform3s(pair.rotation, pair.translation)
    request, result = coal.DistanceRequest(), coal.DistanceResult()
    request.enable_nearest_points = False

    def ask() -> float:
        result.clear()
        return float(coal.distance(a, poses[0], b, poses[1], request, result))

    return ask


class SweptSpheres(peers.Coal):
    """coal's tree that knows distances."""

    name = "coal OBBRSS"

    model = "BVHModelOBBRSS"
