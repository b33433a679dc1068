"""The record of `obbtree first-contact` and its table."""

from __future__ import annotations

from typing import TYPE_CHECKING

from obbcli.report.contacts import contact_part, contacts_bare, contacts_part, contacts_table
from obbcli.report.record import answer_document
from obbcli.report.rows import (
    as_sampled,
    contained_rows,
    cost_rows,
    part_rows,
    source_rows,
    why_open,
)
from obbcli.report.table import Table, length, point

if TYPE_CHECKING:
    from obbcli.answers.contact import FirstContact
    from obbcli.report.contacts import Listing
    from obbcli.report.record import Record, Setting

_AT_HI = {
    "intersecting": "the triangles intersect",
    "within_tolerance": "the points are at most {} apart",
}


def first_contact_record(
    setting: Setting,
    answer: FirstContact,
    listing: Listing | None = None,
    *,
    released_by: float | None = None,
) -> Record:
    """Return the record of a question.

    Args:
        setting: what was asked.
        answer: what came out; its fields become the result, but for the stats.
        listing: the contacts of pairs; None where they were not asked for.
        released_by: mesh units; further apart than this contact began to count. None: it did at
            once.
    """
    result = contact_part(answer, setting.sources)
    if released_by is not None:
        released = None if answer.released is None else list(answer.released)
        result |= {"released": released, "released_by": released_by}
    if listing is not None:
        result |= contacts_part(listing, setting.sources)
    return answer_document("first-contact", setting, result, answer.stats)


def first_contact_tables(record: Record) -> list[Table]:
    """Return the tables of a record: the answer, and the list where it was asked for."""
    result = record["result"]
    rows = [*source_rows(record), ("status", result["status"]), ("answer", _sentence(record))]
    rows += [*_released(result), *_bracket(record), *contained_rows(result)]
    if result["point"] is not None:
        rows.append(("point", point(result["point"])))
    if result["normal"] is not None:
        rows.append(("normal", f"{point(result['normal'])} (from A to B)"))
    if result["triangle_a"] is not None:
        a, b = result["triangle_a"], result["triangle_b"]
        # Triangles that overlap from the start need not meet in any one way.
        way = f" ({result['feature']})" if result["feature"] else ""
        rows.append(("triangles", f"{a} of A and {b} of B{way}"))
    rows += part_rows(result)
    rows += cost_rows(record["stats"])
    return [Table(rows), *([contacts_table(result)] if "contacts" in result else [])]


def first_contact_bare(record: Record) -> str:
    """Return the list where it was asked for, else the status word and, if any, the time."""
    result = record["result"]
    if "contacts" in result:
        return contacts_bare(result)
    time = "" if result["time"] is None else f" {result['time']!r}"
    return f"{result['status']}{time}\n"


def _released(result: Record) -> list[tuple[str, str]]:
    """Return when contact began to count, where that was asked."""
    if result.get("released") is None:
        return []
    low, high = result["released"]
    if low == high:
        return [("released", f"at t = {low!r} s")]
    return [("released", f"at t = {low!r} s, or up to {high - low:.2g} s later")]


def _sentence(record: Record) -> str:
    result = record["result"]
    time = result["time"]
    if "released" in result and result["status"] == "overlap_at_start":
        return "in contact at t = 0 and never released"
    if "released" in result and result["status"] == "separated":
        return "no contact after they were released"
    if "released" in result and result["status"] == "unresolved" and result["released"] is None:
        return f"whether they are released is not known after t = {time!r} s"
    if result["status"] == "separated":
        sampled = as_sampled(result, by_boxes=False) if result["approximate"] else ""
        return f"no contact in the whole duration{sampled}"
    if result["status"] == "unresolved":
        return f"{why_open(record)}; no contact before t = {time!r} s"
    if not result["approximate"]:
        return "in contact at t = 0" if time == 0 else f"first contact at t = {time!r} s"
    if result["evidence"] == "sampled":
        return f"contact at t = {time!r} s{as_sampled(result, by_boxes=result['feature'] == 'box')}"
    bound = f"the surfaces are at most {length(result['error_bound'])} apart"
    if time == 0:
        return f"in contact at t = 0 of boxes: {bound}"
    return f"first contact of boxes at t = {time!r} s: none before, and then {bound}"


def _bracket(record: Record) -> list[tuple[str, str]]:
    """Return what is proven of the time, where it has two ends."""
    result = record["result"]
    low, high = result["time_bounds"] or (None, None)
    if high is None or high == 0 or result["evidence"] == "sampled":
        return []
    at_high = _AT_HI[result["evidence"]].format(length(result["distance"]))
    if low == high:
        return [("bracket", f"no contact before; at that time {at_high}")]
    if result["distance"] > record["accuracy"]["clearance"]:
        passing = f"contact, or they pass each other at most {length(result['distance'])} apart"
        return [("bracket", f"no contact before; up to {high - low:.2g} s later {passing}")]
    return [("bracket", f"no contact before; {high - low:.2g} s later {at_high}")]
