"""The record of `obbtree tradeoff`: rows, front, and settings as exact command lines."""

from __future__ import annotations

import math
import shlex
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from obbcli.accuracy import ASPECTS, Accuracy
from obbcli.report.record import document, finite, part_names
from obbcli.tree.options import DEFAULT_BUILD

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from obbcli.report.record import Record, Setting
    from obbcli.study.tradeoff.trials import Tradeoff, Trial, Unreached

# Of the duration: the errors whose prices are told.
SHARES = (1e-3, 1e-6, 1e-9)
_DEFAULT_BUILD = DEFAULT_BUILD._asdict()


class Wording(NamedTuple):
    """What a command line needs besides a setting.

    Attributes:
        names: A and B as they were written.
        are_trees: which of them are tree files.
        words: the options that place and move them, as they were written.
    """

    names: tuple[str, str]
    are_trees: tuple[bool, bool]
    words: Sequence[str]

    def command(self, build: Mapping[str, Any], accuracy: Accuracy) -> str:
        """Return the command line that asks with a setting; trees are built first where needed."""
        names, lines = list(self.names), []
        extra = build_words(build)
        if extra:
            built: dict[str, str] = {}
            for index, (name, is_tree) in enumerate(zip(self.names, self.are_trees, strict=True)):
                if not is_tree and name not in built:
                    built[name] = _tree_name(name, "ab"[index], built.values())
                    lines.append(["obbtree", "build", name, "-o", built[name], *extra])
                names[index] = built.get(name, name)
        question = ["obbtree", "first-contact", *names, *self.words, *accuracy_words(accuracy)]
        return " && ".join(shlex.join(line) for line in (*lines, question))


class Limits(NamedTuple):
    """What a setting is wanted for: the largest error, s, or gap, mesh units; the longest time, s.

    None where it does not matter.
    """

    max_error: float | None = None
    max_gap: float | None = None
    max_time: float | None = None


def tradeoff_record(
    setting: Setting,
    found: Tradeoff,
    wording: Wording,
    limits: Limits,
    *,
    is_interrupted: bool,
) -> Record:
    """Return the record of a study.

    Args:
        setting: what was asked; its accuracy is the reference's.
        found: what was measured.
        wording: what command lines are made of.
        limits: what a setting is wanted for.
        is_interrupted: whether Ctrl-C ended it.
    """
    rows = [_row_part(row, wording) | part_names(row.answer, setting.sources) for row in found.rows]
    reference = found.reference
    result = {
        "reference": {
            "status": reference.status.value,
            "time": reference.time,
            "time_bounds": reference.time_bounds,
            "evidence": reference.evidence,
            "distance": reference.distance,
            **part_names(reference, setting.sources),
        },
        "rows": rows,
        "unreached": [_unreached_part(one, wording) for one in found.unreached],
        "prices": [_price(found, share) for share in SHARES] if found.duration > 0 else [],
        "recommended": _recommended(found, limits),
        "claims_checked": sum(row.claims_checked for row in found.rows),
        "claims_broken": sum(len(row.faults) for row in found.rows),
        "interrupted": is_interrupted,
    }
    a, b = setting.sources
    return document(
        "tradeoff",
        {"a": a.part(), "b": b.part()},
        motion=setting.motion,
        accuracy=setting.accuracy.as_dict(),
        result=result,
        stats={"budget": found.budget, "seconds": {"study": found.seconds}},
    )


def _row_part(row: Trial, wording: Wording) -> Record:
    answer, stats = row.answer, row.answer.stats
    return {
        "command": wording.command(row.build, row.accuracy),
        "build": row.build,
        "accuracy": row.accuracy.as_dict(),
        "status": answer.status.value,
        "time": answer.time,
        "time_bounds": answer.time_bounds,
        "evidence": answer.evidence,
        "distance": answer.distance,
        "approximate": answer.approximate,
        "error_bound": finite(answer.error_bound),
        "verdict_wrong": row.is_verdict_wrong,
        "time_error": row.time_error,
        "gap": row.gap,
        "claims_checked": row.claims_checked,
        "faults": list(row.faults),
        "on_front": row.on_front,
        "box_tests": stats.box_tests,
        "triangle_tests": stats.triangle_tests,
        "tree_bytes": row.tree_bytes,
        "build_seconds": row.build_seconds,
        "warm_seconds": asdict(row.warm),
    }


def _unreached_part(one: Unreached, wording: Wording) -> Record:
    return {
        "command": wording.command(one.build, one.accuracy),
        "build": one.build,
        "accuracy": one.accuracy.as_dict(),
        "why": one.why,
    }


def _price(found: Tradeoff, share: float) -> Record:
    """Return the fastest rows that err by no more than a share of the duration, by their numbers.

    `ratio_seconds` is the time of the default question over that of the fastest sampled one.
    """
    limit = share * found.duration
    fit = [
        (row.warm.median, index)
        for index, row in enumerate(found.rows)
        if row.error is not None and row.error <= limit
    ]
    sampled = [one for one in fit if found.rows[one[1]].accuracy.method == "sampled"]
    proven = [one for one in fit if found.rows[one[1]].is_proof]
    plain = next((row for row in found.rows if is_plain(row.build, row.accuracy)), None)
    ratio = plain.warm.median / min(sampled)[0] if plain and sampled else None
    return {
        "share_of_duration": share,
        "max_error": limit,
        "cheapest": min(fit)[1] if fit else None,
        "cheapest_proven": min(proven)[1] if proven else None,
        "cheapest_sampled": min(sampled)[1] if sampled else None,
        "ratio_seconds": ratio,
    }


def _recommended(found: Tradeoff, limits: Limits) -> list[Record]:
    """Return which rows fit what was asked for, proven or not; null where none does."""
    parts = []
    error = math.inf if limits.max_error is None else limits.max_error
    gap = math.inf if limits.max_gap is None else limits.max_gap
    if min(error, gap) < math.inf:
        choose = partial(found.cheapest, error, max_gap=gap)
        parts.append(_chosen(found, choose, max_error=limits.max_error, max_gap=limits.max_gap))
    if limits.max_time is not None:
        choose = partial(found.most_accurate, limits.max_time)
        parts.append(_chosen(found, choose, max_time=limits.max_time))
    return parts


def _chosen(found: Tradeoff, choose: Callable[..., Trial | None], **limits: float | None) -> Record:
    numbers = {kind: _index(found, choose(proven=kind == "row_proven")) for kind in _KINDS}
    return {
        "limits": {name: limit for name, limit in limits.items() if limit is not None}
    } | numbers


_KINDS = ("row", "row_proven")


def _index(found: Tradeoff, row: Trial | None) -> int | None:
    return None if row is None else next(k for k, one in enumerate(found.rows) if one is row)


def is_plain(build: Mapping[str, Any], accuracy: Accuracy) -> bool:
    """Return whether a setting is the default one, as far as it may be chosen."""
    default = Accuracy()
    is_default = all(
        getattr(accuracy, name) == getattr(default, name)
        for name, aspect in ASPECTS.items()
        if not aspect.is_shared
    )
    return is_default and not build_words(build)


def build_words(build: Mapping[str, Any]) -> list[str]:
    """Return the options of `obbtree build` that are not its defaults."""
    return _words(build, _DEFAULT_BUILD)


def accuracy_words(accuracy: Accuracy) -> list[str]:
    """Return the options of an accuracy that are not its defaults."""
    values = accuracy.as_dict()
    if values["max_depth_a"] == values["max_depth_b"]:
        values["max_depth"] = values.pop("max_depth_a")
        del values["max_depth_b"]
    return _words(values, Accuracy().as_dict())


def _words(values: Mapping[str, Any], defaults: Mapping[str, Any]) -> list[str]:
    words = []
    for name, value in values.items():
        if value is not None and value != defaults.get(name):
            text = number(value) if isinstance(value, float) else str(value)
            words += [f"--{name.replace('_', '-')}", text]
    return words


def number(value: float) -> str:
    """Return a number as briefly as it can be typed again."""
    short = f"{value:g}"
    return short if float(short) == value else repr(value)


def _tree_name(name: str, side: str, taken: Any) -> str:
    """Return where the tree of a mesh goes, in the folder that the command is given in."""
    stem = Path(name).stem if name != "-" else side
    path = f"{stem}.obbt"
    return f"{stem}-{side}.obbt" if path in taken else path
