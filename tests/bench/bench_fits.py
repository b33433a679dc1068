"""Every fit with every split: boxes and triangles tested, time, volumes; and root boxes by trimesh.

Counts are geometric means over questions of the ratio to those of a tree by area and median. The
same question goes to all trees in turn, and all must give the same answer.
"""

from __future__ import annotations

import math
import time
from collections import defaultdict
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_args

from harness import OURS, Row, alternate, markdown
from moving_sets import DURATION, MOTIONS, OUTCOMES, mesh_pairs, normalized, questions
from scenes.pairs import pairs

import obbcli
from obbcli.mesh import known_suffixes
from obbcli.tree.options import Fit, Split

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from meshes.surfaces import Surface
    from moving_sets import Moving

    Options = tuple[str, str]
    # Which question, and ask it of trees that were built so.
    Question = tuple[str, Callable[[Options], Any]]

QUERIES = 6
QUICK_QUERIES = 2
ROUNDS = 3
OPTIONS: tuple[Options, ...] = tuple(product(get_args(Fit), get_args(Split)))
BASIS: Options = ("triangles", "median")
KINDS = ("apart", "nested", "touching", "distance", *MOTIONS)
SAMPLES = Path(__file__).resolve().parents[2] / "sample_meshes"
SAMPLE_PAIRS = (("gear.stl", "pinion.stl"), ("nut.obj", "bolt.ply"))
REST_TRIANGLES = 10_000
# Of the blobs: others tell little, or take minutes to build 15 times over.
MIN_TRIANGLES, MAX_TRIANGLES = 1000, 50_000
# Half extents are rounded up to floats, axes to a quaternion of floats; of degenerate.ply, 30,000
# times as long as thick, that is 7e-4 of the volume.
ROUNDING = 1e-6
NEEDLE, NEEDLE_ROUNDING = "degenerate.ply", 1e-3


class Trees:
    """The trees of surfaces, built when asked for, whole."""

    def __init__(self) -> None:
        """Begin with none."""
        self._built: dict[Any, Any] = {}

    def get(self, surface: Surface, options: Options) -> Any:
        """Return the tree of a surface."""
        key = (id(surface), options)
        if key not in self._built:
            self._built[key] = (surface, build(surface, options))
        return self._built[key][1]


def build(surface: Surface, options: Options) -> Any:
    """Return a whole tree."""
    fit, split = options
    mesh = obbcli.Mesh(surface.vertices, surface.faces)
    return obbcli.ObbTree.build(mesh, fit=fit, split=split, lazy=False)  # type: ignore[arg-type]


def run(quick: bool, queries: int | None = None, meshes: Path | None = None) -> Iterator[Row]:
    """Yield a row a fit and split, then a row a mesh with the volumes of its root boxes."""
    trees = Trees()
    surfaces = list(_surfaces(quick, meshes))
    ratios: dict[tuple[Options, str], list[float]] = defaultdict(list)
    count = queries or (QUICK_QUERIES if quick else QUERIES)
    for kind, ask in _questions(surfaces, trees, count):
        _gather(kind, ask, ratios)
    volumes = [_volumes(trees, surface) for _, *pair in surfaces for surface in pair]
    timings = [
        alternate({"/".join(o): lambda s=s, o=o: build(s, o) for o in OPTIONS}, ROUNDS)
        for _, s, _ in surfaces
    ]
    for options in OPTIONS:
        name = "/".join(options)
        notes: dict[str, object] = {key: _mean(ratios[options, key]) for key in _keys()}
        notes["volume"] = _mean([of[options] / of[BASIS] for of in volumes])
        basis = "/".join(BASIS)
        notes["build"] = _mean([took[name].median / took[basis].median for took in timings])
        yield Row("fits", name, 0, {}, {OURS: notes})
    yield from _root_rows(meshes)


def _keys() -> list[str]:
    return [f"{kind} {what}" for kind in KINDS for what in ("boxes", "triangles", "time")]


def _mean(ratios: Sequence[float]) -> float:
    return math.exp(sum(map(math.log, ratios)) / len(ratios)) if ratios else math.nan


def _surfaces(quick: bool, meshes: Path | None) -> Iterator[tuple[str, Surface, Surface]]:
    """Yield named pairs: two blobs, sample meshes, and those of the folder."""
    for name, a, b in mesh_pairs(quick, meshes):
        if MIN_TRIANGLES < len(a.faces) < MAX_TRIANGLES:
            yield name, a, b
    for one, two in SAMPLE_PAIRS[:1] if quick else SAMPLE_PAIRS:
        yield f"{one}, {two}", normalized(SAMPLES / one), normalized(SAMPLES / two)


def _questions(
    surfaces: Sequence[tuple[str, Surface, Surface]], trees: Trees, count: int
) -> Iterator[Question]:
    """Yield the pose classes at rest, their distances, and random motions of every kind."""
    for pair in pairs(REST_TRIANGLES):
        pose = obbcli.Pose(pair.rotation, pair.translation)

        def at_rest(options: Options, pair: Any = pair, pose: Any = pose) -> Any:
            a, b = (trees.get(surface, options) for surface in (pair.a, pair.b))
            return obbcli.collide(a, obbcli.Body(b, pose))

        def apart(options: Options, pair: Any = pair, pose: Any = pose) -> Any:
            a, b = (trees.get(surface, options) for surface in (pair.a, pair.b))
            return obbcli.distance(a, obbcli.Body(b, pose))

        is_apart = str(at_rest(BASIS).status.value) == "separated"
        yield pair.name if pair.name == "nested" else "apart" if is_apart else "touching", at_rest
        yield "distance", apart

    def first(question: Moving, options: Options) -> Any:
        bodies = []
        for surface, path in ((question.a, question.path_a), (question.b, question.path_b)):
            motion = obbcli.Motion(path.velocity, path.spin, path.center)
            pose = obbcli.Pose(path.rotation, path.center)
            bodies.append(obbcli.Body(trees.get(surface, options), pose, motion))
        return obbcli.first_contact(bodies[0], bodies[1], DURATION)

    def collides(question: Moving) -> bool:
        return str(first(question, BASIS).status.value) != "separated"

    for (name, a, b), motion, outcome in product(surfaces, MOTIONS, OUTCOMES):
        for question in questions(name, (a, b), motion, outcome, count, collides):
            yield motion, lambda options, question=question: first(question, options)


def _gather(
    kind: str,
    ask: Callable[[Options], Any],
    ratios: Mapping[tuple[Options, str], list[float]],
) -> None:
    """Ask all trees, check that they agree, and note what it cost each."""
    answers, costs = {}, {}
    for options in OPTIONS:
        ask(options)
        start = time.perf_counter()
        answer = ask(options)
        seconds = time.perf_counter() - start
        stats = answer.stats
        answers[options] = _said(answer)
        costs[options] = (1 + stats.box_tests, 1 + stats.triangle_tests, seconds)
    for said in answers.values():
        _assert_agree(said, answers[BASIS])
    for options, cost in costs.items():
        whats = ("boxes", "triangles", "time")
        for what, own, basis in zip(whats, cost, costs[BASIS], strict=True):
            ratios[options, f"{kind} {what}"].append(own / basis)


def _said(answer: Any) -> tuple[str, tuple[float, float] | None]:
    """Return the status, and what the answer's number is proven to lie between."""
    if hasattr(answer, "bounds"):
        return "distance", answer.bounds
    return answer.status.value, getattr(answer, "time_bounds", None)


def _assert_agree(said: Any, other: Any) -> None:
    assert said[0] == other[0], (said, other)
    if said[1] is not None and other[1] is not None and None not in (*said[1], *other[1]):
        assert max(said[1][0], other[1][0]) <= min(said[1][1], other[1][1]), (said, other)


def _volumes(trees: Trees, surface: Surface) -> dict[Options, float]:
    """Return the sum of all boxes' volumes by how they were built."""
    return {
        options: sum(level.volume for level in trees.get(surface, options).levels)
        for options in OPTIONS
    }


def _root_rows(meshes: Path | None) -> Iterator[Row]:
    """Yield each mesh's root boxes against `trimesh.bounds.oriented_bounds`."""
    import trimesh

    names = sorted(path for path in SAMPLES.iterdir() if path.suffix in known_suffixes())
    for path in [*names, *(sorted(Path(meshes).glob("*.obj")) if meshes else ())]:
        mesh = obbcli.load_mesh(path)
        theirs = math.prod(trimesh.bounds.oriented_bounds(mesh.vertices)[1])
        notes: dict[str, object] = {}
        for fit in get_args(Fit):
            root = obbcli.ObbTree.build(mesh, fit=fit, max_depth=0).levels[0]
            notes[fit] = root.volume / theirs if root.volume is not None else None
        slack = NEEDLE_ROUNDING if path.name == NEEDLE else ROUNDING
        assert isinstance(notes["min-volume"], float), path.name
        assert notes["min-volume"] <= 1 + slack, (path.name, notes)
        calls = {
            "min-volume": lambda mesh=mesh: obbcli.ObbTree.build(
                mesh, fit="min-volume", max_depth=0
            ),
            "trimesh": lambda mesh=mesh: trimesh.bounds.oriented_bounds(mesh.vertices),
        }
        timings = alternate(calls, ROUNDS)
        yield Row("root boxes", path.name, len(mesh.triangles), timings, {"volume": notes})


def tables(rows: Sequence[Row]) -> str:
    """Return the ratios as a table: a line a fit and split."""
    lines = [["fit/split", *rows[0].notes[OURS]]]
    lines += [[row.case, *(f"{value:.2f}" for value in row.notes[OURS].values())] for row in rows]
    return markdown(lines)
