"""What `obbtree scene` is asked for, and which flags contradict each other."""

from __future__ import annotations

from typing import NamedTuple

from obbcli.cli.boundary import UsageError

_OF_CONTACTS = ("first", "all_contacts", "threads")


class Wanted(NamedTuple):
    """Which contacts, overlaps or clearances are asked for."""

    pairs: tuple[str, ...]
    first: bool
    all_contacts: bool
    limit: int | None
    solid: bool
    threads: int | None
    overlaps: bool
    tolerance: float | None
    touch: tuple[float, float] | None
    least_clearance: bool
    within: float | None
    at_least: float | None


def refuse_contradictions(wanted: Wanted) -> None:
    """Refuse flags of which one would be ignored.

    Raises:
        UsageError: there is one.
    """
    if wanted.first:
        for name in ("all_contacts", "limit"):
            if getattr(wanted, name):
                fault = "lists contacts, and --first asks for one"
                raise UsageError(_flag(name), fault, "leave out one of the two")
    if wanted.threads is not None and (wanted.first or wanted.all_contacts):
        other = "--first" if wanted.first else "--all-contacts"
        fault = f"one question is asked at a time with {other}"
        raise UsageError("--threads", fault, "leave out one of the two")
    _refuse_of_other_questions(wanted)
    if wanted.solid and wanted.all_contacts:
        fault = "lists triangles that meet, and a body inside another has none"
        raise UsageError("--all-contacts", fault, "leave out it or --solid")


def _refuse_of_other_questions(wanted: Wanted) -> None:
    """Refuse flags that say nothing about what is asked for."""
    if wanted.overlaps and wanted.least_clearance:
        raise UsageError("--least-clearance", "is another question", "leave out it or --overlaps")
    if wanted.overlaps:
        _refuse(wanted, (*_OF_CONTACTS, "limit", "solid"), "says nothing about overlaps at t = 0")
    if wanted.least_clearance:
        _refuse(wanted, _OF_CONTACTS, "says nothing about least clearances")
    needed = {
        "tolerance": (wanted.overlaps or wanted.least_clearance, "about depths or clearances"),
        "touch": (wanted.overlaps, "about depths"),
        "within": (wanted.least_clearance, "about clearances"),
        "at_least": (wanted.least_clearance, "about clearances"),
    }
    for name, (is_asked, words) in needed.items():
        if getattr(wanted, name) is not None and not is_asked:
            depths, gaps = "depths" in words, "clearances" in words
            flags = ["--overlaps"] * depths + ["--least-clearance"] * gaps
            raise UsageError(_flag(name), f"is {words}", "add " + " or ".join(flags))


def _refuse(wanted: Wanted, names: tuple[str, ...], fault: str) -> None:
    for name in names:
        if getattr(wanted, name):
            raise UsageError(_flag(name), fault, "leave it out")


def _flag(name: str) -> str:
    return f"--{name.replace('_', '-')}"
