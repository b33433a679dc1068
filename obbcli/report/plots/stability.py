"""The plot of `obbtree stability`: every extreme, family by family. Needs matplotlib."""

from __future__ import annotations

import io
import math
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from obbcli.report.record import Record

# Outcome: what the legend calls it, color, marker, size.
_OUTCOMES = {
    "same": ("same bits", "#1b6ca8", "o", 44),
    "agrees": ("other bits, both can be true", "#63a7d8", "s", 34),
    "within bound": ("differs, by no more than the input does", "#e0a13a", "D", 32),
    "unresolved": ("no answer within the limit", "#8a8a8a", "v", 44),
    "refused": ("beyond the doubles", "#8a8a8a", "x", 44),
    "broken": ("BROKEN", "#c00000", "X", 130),
}
_TICKS = (-300, -100, -30, -10, -3, -1, 0, 1, 3, 10, 30, 100, 300)
# Extremes of one size, as before and after a contact, stand this far apart.
_STEP = 0.22


def stability_plot(record: Record, kind: str) -> bytes:
    """Return the picture of a record, as the bytes of a file of that kind (`svg` or `png`)."""
    # The picture alone needs it: it is no dependency of anything else.
    import matplotlib as mpl
    from matplotlib.figure import Figure

    rows = record["result"]["rows"]
    names = list(dict.fromkeys(row["family"] for row in rows))
    figure = Figure(figsize=(10, 1.9 + 0.36 * max(len(names), 4)), layout="constrained")
    axes: Any = figure.add_subplot()
    places = _places(rows, names)
    for outcome, (text, color, marker, size) in _OUTCOMES.items():
        chosen = [k for k, row in enumerate(rows) if row["outcome"] == outcome]
        if chosen:
            xs, ys = zip(*(places[k] for k in chosen), strict=True)
            label = f"{text} ({len(chosen)})"
            # Those that overlap stay apart by their edges; a cross is nothing but its lines.
            edge = {} if marker == "x" else {"edgecolors": "white", "linewidths": 0.7}
            style = {"s": size, "color": color, "marker": marker, "zorder": 3} | edge
            axes.scatter(xs, ys, label=label, **style)
    _scales(axes, names)
    _words(figure, axes, record)
    stream = io.BytesIO()
    # The same answers give the same bytes: no date, and ids that do not depend on the process.
    with mpl.rc_context({"svg.hashsalt": "obbtree"}):
        metadata = {"Date": None} if kind == "svg" else None
        figure.savefig(stream, format=kind, dpi=130, metadata=metadata)
    return stream.getvalue()


def _places(rows: list[Record], names: list[str]) -> list[tuple[float, float]]:
    """Return where each row is drawn; those that would hide each other stand one above another."""
    taken: dict[tuple[str, float], int] = {}
    places = []
    for row in rows:
        x = _across(row["magnitude"])
        number = taken.get((row["family"], x), 0)
        taken[row["family"], x] = number + 1
        places.append((x, names.index(row["family"]) - number * _STEP))
    return places


def _across(magnitude: float) -> float:
    """Return the place of a magnitude: its power of ten, on an axis that is logarithmic itself."""
    if magnitude == 0:
        return _across(1e-18)
    power = math.log10(magnitude)
    return math.copysign(math.log2(1.0 + abs(power)), power)


def _scales(axes: Any, names: list[str]) -> None:
    axes.set_yticks(range(len(names)), names)
    axes.set_ylim(len(names) - 0.4, -0.8)
    axes.set_xticks([_across(10.0**power) for power in _TICKS], [_power(p) for p in _TICKS])
    axes.set_xlim(_across(1e-307) - 0.3, _across(1e307) + 0.5)
    axes.grid(color="#e4e4e4", linewidth=0.8)
    axes.set_axisbelow(True)
    for side in ("top", "right", "left"):
        axes.spines[side].set_visible(False)
    axes.tick_params(left=False)
    axes.set_xlabel(
        "how extreme: factor, sizes, rad, share of the time, relative rounding; or a plain number"
    )


def _power(power: int) -> str:
    return "1" if power == 0 else f"$10^{{{power}}}$"


def _words(figure: Any, axes: Any, record: Record) -> None:
    result = record["result"]
    a, b = (record["inputs"][name]["path"].rpartition("/")[2] for name in "ab")
    broken = result["broken_count"]
    end = "none is broken" if not broken else f"{broken} BROKEN"
    axes.set_title(f"{a} and {b}: {result['tried_count']} extremes, {end}", loc="left")
    if result["rows"]:
        figure.legend(loc="outside lower center", ncols=3, frameon=False)
