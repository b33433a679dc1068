"""The record of `obbtree distance` and its table."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from obbcli.report.record import answer_document, part_names
from obbcli.report.rows import cost_rows, part_rows, source_rows
from obbcli.report.table import Table, point

if TYPE_CHECKING:
    from obbcli.answers.distance import Distance
    from obbcli.report.record import Record, Setting


def distance_record(setting: Setting, answer: Distance, *, is_complete: bool) -> Record:
    """Return the record of a question.

    Args:
        setting: what was asked.
        answer: what came out.
        is_complete: whether the search ended before a limit of pops or time.
    """
    result = {
        "distance": answer.distance,
        "bounds": list(answer.bounds),
        "point_a": list(answer.point_a),
        "point_b": list(answer.point_b),
        "triangle_a": answer.triangle_a,
        "triangle_b": answer.triangle_b,
        "complete": is_complete,
        **part_names(answer, setting.sources),
    }
    return answer_document("distance", setting, result, answer.stats)


def distance_tables(record: Record) -> list[Table]:
    """Return the table of a record."""
    result = record["result"]
    touches = result["distance"] == 0
    rows = [
        *source_rows(record),
        ("distance", f"{result['distance']!r}{' (they touch)' if touches else ''}"),
        *([] if touches else [("bounds", _bounds(result))]),
        ("point of A", f"{point(result['point_a'])} (triangle {result['triangle_a']})"),
        ("point of B", f"{point(result['point_b'])} (triangle {result['triangle_b']})"),
    ]
    rows += part_rows(result)
    return [Table([*rows, *cost_rows(record["stats"])])]


def distance_bare(record: Record) -> str:
    """Return one number for the distance, which lies within its bounds.

    It is a bound where that is the distance of the two points as they are printed, else the middle
    of the bounds: counted roundings widen them to both sides, so that cubes 3 apart print 3.0.
    """
    result = record["result"]
    low, high = result["bounds"]
    measured = math.dist(result["point_a"], result["point_b"])
    told = measured if measured in (low, high) else low + (high - low) / 2
    return f"{told!r}\n"


def _bounds(result: Record) -> str:
    low, high = result["bounds"]
    cut = "" if result["complete"] else "; a limit was reached"
    return f"{low!r} to {high!r}, proven{cut}"
