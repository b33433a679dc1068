"""What a study of the trade measures: how trees are built, and how far a question is pursued.

Not every combination: methods are varied on the default trees, trees under the default question,
and then the best of either are crossed. The small come first, so that any budget gives a whole,
if coarse, picture.
"""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import product
from typing import TYPE_CHECKING, NamedTuple, get_args

from obbcli.accuracy import ASPECTS, Accuracy, Integrator
from obbcli.tree.options import DEFAULT_BUILD, FITS, SPLITS, BuildOptions

if TYPE_CHECKING:
    from collections.abc import Iterator

# Of the duration; the reference is asked for the last, 1e-9 is the default.
_TIME_TOLERANCES = (1e-3, 1e-6)
REFERENCE_TOLERANCE = 1e-12
# Of the pair's size.
_DISTANCE_TOLERANCES = (1e-2, 1e-4, 1e-6)
_DEPTHS = (2, 4, 6, 8, 10, 12, 14, 16, 18, 20)
_LEAF_SIZES = (2, 4, 8, 16)
_COARSE_LEAVES = (4, 16)
_BUILD_DEPTHS = (8, 12)
# Steps of the sampled method: a few, some, and as many as a large budget is for.
_FEW, _SOME, _MANY = (1, 4, 16, 64, 256), (1024, 4096), (16384, 65536, 262144, 1048576)


class Setting(NamedTuple):
    """What one row measures."""

    build: BuildOptions
    accuracy: Accuracy


class Scale(NamedTuple):
    """What the steps of a grid are relative to.

    Attributes:
        duration: s; 0 where nothing moves.
        size: of the pair, mesh units.
        turns: whether a body turns, so that sampling differs from the truth.
        levels: about how many the deeper of the two trees has.
    """

    duration: float
    size: float
    turns: bool
    levels: int


def reference_of(asked: Accuracy, duration: float) -> Accuracy:
    """Return the accuracy of the answer that the others are held against: certified and tight."""
    base = shared_part(asked)
    tolerance = REFERENCE_TOLERANCE * duration
    if asked.time_tolerance is not None:
        tolerance = min(tolerance, asked.time_tolerance)
    return replace(base, time_tolerance=tolerance) if duration > 0 else base


def shared_part(asked: Accuracy) -> Accuracy:
    """Return what all settings share of the accuracy asked for: clearance and limits."""
    shared = {name: getattr(asked, name) for name, aspect in ASPECTS.items() if aspect.is_shared}
    return Accuracy(**shared)


def plan(asked: Accuracy, scale: Scale, *, varies_trees: bool) -> Iterator[Setting]:
    """Yield the settings that are measured, each once, the cheap before the expensive.

    Args:
        asked: what the user would ask with; measured as well.
        scale: what tolerances are relative to.
        varies_trees: whether a body came as a mesh, so that its tree can be built in other ways.
    """
    base = shared_part(asked)
    stages = [_own(asked, base), _certified(base, scale), _depths(base, scale)]
    stages.append(_sampled(base, scale, _FEW))
    if varies_trees:
        stages += [_trees(base, slow=False), _leaves(base)]
    stages.append(_sampled(base, scale, _SOME))
    if varies_trees:
        stages.append(_trees(base, slow=True))
    stages.append(_sampled(base, scale, _MANY))
    seen: set[Setting] = set()
    for setting in (one for stage in stages for one in stage):
        if setting not in seen:
            seen.add(setting)
            yield setting


def _own(asked: Accuracy, base: Accuracy) -> Iterator[Setting]:
    yield Setting(DEFAULT_BUILD, base)
    yield Setting(DEFAULT_BUILD, asked)


def _certified(base: Accuracy, scale: Scale) -> Iterator[Setting]:
    if scale.duration > 0:
        for share in _TIME_TOLERANCES:
            yield Setting(
                DEFAULT_BUILD, replace(base, time_tolerance=_round(share * scale.duration))
            )
        for share in _DISTANCE_TOLERANCES:
            yield Setting(
                DEFAULT_BUILD, replace(base, distance_tolerance=_round(share * scale.size))
            )


def _depths(base: Accuracy, scale: Scale) -> Iterator[Setting]:
    for depth in _DEPTHS:
        if depth < scale.levels:
            yield Setting(DEFAULT_BUILD, replace(base, max_depth_a=depth, max_depth_b=depth))


def _sampled(base: Accuracy, scale: Scale, counts: tuple[int, ...]) -> Iterator[Setting]:
    if scale.duration == 0:
        return
    integrators: tuple[Integrator, ...] = get_args(Integrator)
    if not scale.turns:  # one step, whatever is asked for
        counts, integrators = counts[:1] if counts[0] == 1 else (), ("exact",)
    if counts is _MANY:  # by then they differ by far less than the steps leave out
        integrators = ("exact",)
    for steps, integrator in product(counts, integrators):
        way = replace(base, method="sampled", integrator=integrator, steps=steps)
        yield Setting(DEFAULT_BUILD, way)


def _trees(base: Accuracy, *, slow: bool) -> Iterator[Setting]:
    for fit, split in product(FITS, SPLITS):
        build = BuildOptions(fit, split)
        if build.needs_hulls is slow:
            yield Setting(build, base)


def _leaves(base: Accuracy) -> Iterator[Setting]:
    for leaf_size in _LEAF_SIZES:
        yield Setting(BuildOptions(leaf_size=leaf_size), base)
    for leaf_size in _COARSE_LEAVES:
        yield Setting(BuildOptions(leaf_size=leaf_size), replace(base, leaves="boxes"))
    for depth in _BUILD_DEPTHS:
        yield Setting(BuildOptions(max_depth=depth), base)


def levels_of(triangle_count: int) -> int:
    """Return about how many levels a tree over so many triangles has."""
    return math.ceil(math.log2(max(triangle_count, 2))) + 2


def _round(value: float) -> float:
    """Return one digit of a number: nobody wants to type more."""
    return float(f"{value:.0e}")
