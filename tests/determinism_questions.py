"""What `determinism` asks: the questions, their parts, and what of their answers is measured."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

PARTS = {
    "gear": "gear.stl",
    "pinion": "pinion.stl",
    "link_a": "chain_link_a.off",
    "link_b": "chain_link_b.ply",
    "bolt": "bolt.ply",
    "nut": "nut.obj",
}
LARGE = "large.stl"
SPIN = ("--omega", "0", "0", "0.1")
PULL = ("--vel", "0", "0", "-5")
TUMBLE = (*PULL, "--omega", "0.3", "1.1", "-0.7", "--rotate-b", "0.1", "0.2", "0.3")


@dataclass(frozen=True)
class Question:
    """A command; `{name}` in its arguments is the path of a part, as the way has it."""

    arguments: tuple[str, ...]
    parts: tuple[str, ...] = ()
    file: str | None = None  # the answer is this file, and not what is printed
    takes: tuple[str, ...] = ("piped", "verify")
    forgets: Callable[[Any], Any] | None = None
    is_slow: bool = False


def without_measurements(document: Any) -> Any:
    """Return what a study claims of the trees it was given, without the times it is about.

    Which trees are built besides, and what is tried on the fastest of them, hangs on those times.
    """
    keys = ("status", "time", "time_bounds", "evidence", "distance", "error_bound", "gap", "faults")
    result = document["result"]
    first = result["rows"][0]["build"]
    rows = [
        {key: row[key] for key in ("accuracy", *keys)}
        for row in result["rows"]
        if row["build"] == first
    ]
    return [result["reference"], rows, result["claims_broken"]]


QUESTIONS = {
    "build, the file": Question(
        ("build", "{large}", "--force", "-o", "{out}"), ("large",), "large.obbt", ()
    ),
    "build": Question(("build", "{gear}", "--force", "-o", "{out}"), ("gear",), None, ()),
    "info": Question(("info", "{gear}", "--check"), ("gear",), None, ("verify",)),
    "info, a tree": Question(("info", "{tree}", "--check"), (), None, ("verify",)),
    "collide": Question(("collide", "{gear}", "{pinion}"), ("gear", "pinion")),
    "collide --solid": Question(("collide", "{bolt}", "{nut}", "--solid"), ("bolt", "nut")),
    "collide --all-pairs": Question(
        ("collide", "{gear}", "{pinion}", "--all-pairs", "--translate-b", "-1", "0", "0"),
        ("gear", "pinion"),
    ),
    "first-contact": Question(("first-contact", "{gear}", "{pinion}", *SPIN), ("gear", "pinion")),
    "first-contact, tumbling": Question(
        ("first-contact", "{link_a}", "{link_b}", *TUMBLE), ("link_a", "link_b")
    ),
    "first-contact --all-contacts": Question(
        ("first-contact", "{link_a}", "{link_b}", *PULL, "--all-contacts"), ("link_a", "link_b")
    ),
    "first-contact, sampled": Question(
        ("first-contact", "{link_a}", "{link_b}", *TUMBLE, "--method", "sampled", "--integrator",
         "rk4"),
        ("link_a", "link_b"),
    ),
    "distance": Question(("distance", "{link_a}", "{link_b}"), ("link_a", "link_b")),
    "overlap": Question(
        ("overlap", "{gear}", "{pinion}", "--translate", "0.5", "0", "0", "--regions"),
        ("gear", "pinion"),
    ),
    "clearance": Question(("clearance", "{gear}", "{pinion}", *SPIN), ("gear", "pinion")),
    "intervals": Question(("intervals", "{link_a}", "{link_b}", *PULL), ("link_a", "link_b")),
    "range": Question(("range", "{gear}", "{pinion}", *SPIN), ("gear", "pinion")),
    "scene": Question(("scene", "{scene}"), (), None, ("verify",)),
    "scene --overlaps": Question(("scene", "{scene}", "--overlaps"), (), None, ("verify",)),
    "scene --least-clearance": Question(
        ("scene", "{scene}", "--least-clearance", "--within", "20"), (), None, ("verify",)
    ),
    "scene --all-contacts": Question(
        ("scene", "{scene}", "--all-contacts", "--limit", "20"), (), None, ("verify",)
    ),
    "sweep, the results": Question(
        ("sweep", "{gear}", "{pinion}", "{queries}", "-o", "{out}", "--force", "--duration", "0.5",
         "--omega", "0", "0", "3"),
        ("gear", "pinion"), "results.jsonl",
    ),
    "stability": Question(
        ("stability", "{link_a}", "{link_b}", *PULL), ("link_a", "link_b"), is_slow=True
    ),
    "tradeoff, what is claimed": Question(
        ("tradeoff", "{link_a}", "{link_b}", *PULL, "--budget", "60"), ("link_a", "link_b"),
        forgets=without_measurements, is_slow=True,
    ),
}  # fmt: skip
