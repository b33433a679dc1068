"""The plot of `obbtree tradeoff`: error against time, both logarithmic. Needs matplotlib."""

from __future__ import annotations

import io
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from obbcli.report.table import seconds
from obbcli.report.tradeoff_tables import label

if TYPE_CHECKING:
    from obbcli.report.record import Record

# Rows by what makes them what they are: name, color, marker.
_KINDS = {
    "certified": ("certified", "#1b6ca8", "o"),
    "trees": ("certified, other trees", "#63a7d8", "s"),
    "coarse": ("boxes: depth limits, coarse leaves", "#8a6d3b", "D"),
    "sampled": ("sampled, in so many steps", "#c8553d", "^"),
}
# How far apart the lanes of no error and of wrong verdicts are from the decades: in decades.
_LANE = 1.5
# How many settings of the front the legend has room for.
_NAMED = 11
_NEXT_LINE = "\n"


def tradeoff_plot(record: Record, kind: str) -> bytes:
    """Return the picture of a record, as the bytes of a file of that kind (`svg` or `png`)."""
    # The picture alone needs it: it is no dependency of anything else.
    from matplotlib.figure import Figure

    figure = Figure(figsize=(12, 6.4), layout="constrained")
    axes: Any = figure.add_subplot()
    rows = [row for row in record["result"]["rows"] if row["status"] != "unresolved"]
    low, high = _decades(rows)
    places = [_place(row, low, high) for row in rows]
    for name, (text, color, marker) in _KINDS.items():
        chosen = [k for k, row in enumerate(rows) if _kind(row) == name]
        off = [k for k in chosen if not rows[k]["on_front"]]
        on = [k for k in chosen if rows[k]["on_front"]]
        style = {"color": color, "marker": marker}
        _scatter(axes, [places[k] for k in off], s=26, alpha=0.45, linewidths=0, **style)
        _scatter(axes, [places[k] for k in on], s=110, edgecolors="black", zorder=3, **style)
        if chosen:
            axes.scatter([], [], s=40, label=f"{text} ({len(chosen)})", **style)
    _front(axes, rows, places)
    _steps(axes, rows, places)
    _scales(axes, rows, low, high)
    _words(axes, record)
    stream = io.BytesIO()
    figure.savefig(stream, format=kind, dpi=130)
    return stream.getvalue()


def _scatter(axes: Any, places: list[tuple[float, float]], **style: Any) -> None:
    if places:
        axes.scatter(*zip(*places, strict=True), **style)


def _kind(row: Record) -> str:
    accuracy = row["accuracy"]
    if accuracy["method"] == "sampled":
        return "sampled"
    depths = (accuracy["max_depth_a"], accuracy["max_depth_b"])
    if accuracy["leaves"] == "boxes" or depths != (None, None):
        return "coarse"
    return "trees" if label(row).startswith("build ") else "certified"


def _decades(rows: list[Record]) -> tuple[int, int]:
    """Return the powers of ten that hold all errors but 0 and wrong verdicts."""
    errors = [abs(row["time_error"]) for row in rows if row["time_error"]]
    if not errors:
        return -9, 0
    low, high = math.floor(math.log10(min(errors))), math.ceil(math.log10(max(errors)))
    return low, max(high, low + 1)


def _place(row: Record, low: int, high: int) -> tuple[float, float]:
    """Return time in s and the decimal logarithm of the error, or the lane of rows without one."""
    if row["verdict_wrong"]:
        height = high + _LANE
    elif not row["time_error"]:
        height = low - _LANE
    else:
        height = math.log10(abs(row["time_error"]))
    return row["warm_seconds"]["median"], height


def _front(axes: Any, rows: list[Record], places: list[tuple[float, float]]) -> None:
    """Draw the front as a staircase, its corners numbered, and name them in the legend."""
    both = zip(places, rows, strict=True)
    front = sorted(((place, row) for place, row in both if row["on_front"]), key=lambda one: one[0])
    if not front:
        return
    corners = [place for place, _ in front]
    axes.step(*zip(*corners, strict=True), where="post", color="black", linewidth=1.2, zorder=2)
    axes.scatter([], [], s=0, label="the front, fastest first:")
    every = math.ceil(len(front) / _NAMED)
    for number, (place, row) in enumerate(front, start=1):
        axes.annotate(
            str(number), place, ha="center", va="center", fontsize=7, color="white", zorder=4
        )
        if (len(front) - number) % every:  # a legend has room for some; the last is always there
            continue
        error = "no error" if not row["time_error"] else f"{abs(row['time_error']):.1g} s"
        text = f"{label(row).replace('; ', _NEXT_LINE)}{_NEXT_LINE}{seconds(place[0])}, {error}"
        axes.scatter([], [], s=60, color="black", marker=f"${number}$", label=text)


def _steps(axes: Any, rows: list[Record], places: list[tuple[float, float]]) -> None:
    """Say of sampled rows in how many steps: those that turn frames in closed form."""
    for row, place in zip(rows, places, strict=True):
        accuracy = row["accuracy"]
        if accuracy["method"] == "sampled" and accuracy["integrator"] == "exact":
            text = f"{accuracy['steps']:,}"
            color = _KINDS["sampled"][1]
            axes.annotate(
                text,
                place,
                (0, 6),
                textcoords="offset points",
                ha="center",
                fontsize=7,
                color=color,
            )


def _scales(axes: Any, rows: list[Record], low: int, high: int) -> None:
    """Set the axes: seconds across, decades of error upwards, lanes for none and for wrong."""
    times = [row["warm_seconds"]["median"] for row in rows] or [1e-3]
    axes.set_xscale("log")
    axes.set_xlim(min(times) / 1.6, max(times) * 4)
    step = max(1, math.ceil((high - low) / 10))
    ticks = {float(power): f"$10^{{{power}}}$" for power in range(low, high + 1, step)}
    if any(not (row["time_error"] or row["verdict_wrong"]) for row in rows):
        ticks[low - _LANE] = "none"
        axes.axhspan(low - 2 * _LANE, low - _LANE / 2, color="#e8f3e8", zorder=0)
    if any(row["verdict_wrong"] for row in rows):
        ticks[high + _LANE] = "wrong\nverdict"
        axes.axhspan(high + _LANE / 2, high + 2 * _LANE, color="#f7e3df", zorder=0)
    axes.set_ylim(min(ticks) - _LANE / 2, max(ticks) + _LANE / 2)
    axes.set_yticks(list(ticks), list(ticks.values()))
    axes.grid(visible=True, which="major", color="#dddddd", linewidth=0.6)
    axes.set_axisbelow(True)


def _words(axes: Any, record: Record) -> None:
    inputs, result = record["inputs"], record["result"]
    names = " and ".join(Path(inputs[side]["path"]).name for side in ("a", "b"))
    status = result["reference"]["status"].replace("_", " ")
    axes.set_title(f"{names}: what speed costs in accuracy (truth: {status})", loc="left")
    axes.set_xlabel("time of a question, warm, median [s]")
    axes.set_ylabel("error of the contact's time against the certified answer [s]")
    axes.figure.legend(loc="outside right upper", fontsize=8, frameon=False, labelspacing=0.7)
