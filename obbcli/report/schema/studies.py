"""Schemas of what `obbtree tradeoff` and `obbtree stability` measure."""

from __future__ import annotations

from typing import get_args

from obbcli.answers.overlap import RelationWord
from obbcli.report.schema.relations import overlap_fields
from obbcli.report.schema.shared import (
    CONTACT_FIELDS,
    PART_NAMES,
    SECONDS,
    STATUS,
    TIME_BOUNDS,
    pair_document,
)
from obbcli.report.schema.words import (
    AMOUNT,
    COUNT,
    FLAG,
    NUMBER,
    TEXT,
    Schema,
    documented,
    list_of,
    or_null,
    record,
    ref,
    table_of,
    told,
    tuple_of,
    word_of,
)
from obbcli.study.asks import ASKS
from obbcli.study.stability.rows import Outcome, RestRow, Row
from obbcli.study.tradeoff.at_rest import RestTrial
from obbcli.study.tradeoff.trials import Timing, Trial

_COMMAND = told(TEXT, "the command line that asks with this setting")
_ROW_NUMBER = or_null(COUNT)


def tradeoff() -> Schema:
    """Return the schema of `obbtree tradeoff`."""
    result = {
        "reference": told(
            record(
                _answered("status", "time", "time_bounds", "evidence", "distance") | PART_NAMES,
                optional=PART_NAMES,
            ),
            "The certified answer that errors are measured against.",
        ),
        "rows": told(
            list_of(record(_trial() | PART_NAMES, optional=PART_NAMES)),
            "the settings that were measured",
        ),
        "unreached": told(
            list_of(record(_SETTING | {"why": TEXT})), "settings that the budget did not reach"
        ),
        "prices": told(list_of(record(_PRICE)), "what an error costs; empty of bodies at rest"),
        "recommended": told(list_of(_RECOMMENDED), "one a limit that was given"),
        "claims_checked": told(COUNT, "of all rows"),
        "claims_broken": told(COUNT, "of them, that turned out untrue: should be 0"),
        "interrupted": told(FLAG, "whether Ctrl-C ended it"),
    }
    budget = told(AMOUNT, "s that it was allowed")
    stats = record({"budget": budget, "seconds": SECONDS})
    either = {"anyOf": [record(result), record(_rest_tradeoff())]}
    return pair_document("tradeoff", either, stats=stats)


def _rest_tradeoff() -> dict[str, Schema]:
    """Return the fields of what a tolerance costs of a question about t = 0."""
    row = documented(
        RestTrial,
        {
            "command": _COMMAND,
            "options": told(list_of(TEXT), "of that command line, beside those of the bodies"),
            "relation": or_null(word_of(get_args(RelationWord))),
            "bounds": table_of(tuple_of(AMOUNT, or_null(AMOUNT)), "by the names of the numbers"),
            "width": or_null(AMOUNT),
            "claims_checked": COUNT,
            "faults": list_of(TEXT),
            "warm_seconds": told(record(_timing()), "s a call"),
            "on_front": FLAG,
        },
    )
    return {
        "ask": told(word_of(ASKS[1:]), "which question"),
        "reference": told(studied_answer(), "The narrowest answer, that others are held against."),
        "rows": told(list_of(record(row)), "the settings that were measured"),
        "unreached": told(list_of(TEXT), "command lines that the budget did not reach"),
        "recommended": told(_ROW_NUMBER, "the narrowest row within --max-time; null without"),
        "claims_checked": told(COUNT, "of all rows"),
        "claims_broken": told(COUNT, "of them, that turned out untrue: should be 0"),
        "interrupted": told(FLAG, "whether Ctrl-C ended it"),
    }


def _timing() -> dict[str, Schema]:
    """Return the fields of how long calls took."""
    return documented(
        Timing,
        {
            "median": AMOUNT,
            "low_quartile": AMOUNT,
            "high_quartile": AMOUNT,
            "interval": or_null(tuple_of(AMOUNT, AMOUNT)),
            "rounds": COUNT,
        },
    )


_AS_THEY_CAME = {"type": "object", "maxProperties": 0, "description": "The trees as they came."}
_BUILD = {"oneOf": [ref("build"), _AS_THEY_CAME]}
_SETTING = {"command": _COMMAND, "build": _BUILD, "accuracy": ref("accuracy")}
_PRICE = {
    "share_of_duration": NUMBER,
    "max_error": told(AMOUNT, "s; that share"),
    "cheapest": told(_ROW_NUMBER, "the fastest row that errs by no more"),
    "cheapest_proven": told(_ROW_NUMBER, "the fastest of those that prove it"),
    "cheapest_sampled": told(_ROW_NUMBER, "the fastest of those that sample"),
    "ratio_seconds": told(or_null(AMOUNT), "the default question's time by that of the sampled"),
}
_RECOMMENDED = record(
    {
        "limits": table_of(AMOUNT, "what was asked for: max_error, s; max_gap; max_time, s"),
        "row": told(_ROW_NUMBER, "that fits; null where none does"),
        "row_proven": told(_ROW_NUMBER, "that fits and is a proof; null where none does"),
    }
)


def _trial() -> dict[str, Schema]:
    """Return the fields of a setting that was measured."""
    measured = documented(
        Trial,
        {
            "time_error": or_null(NUMBER),
            "gap": or_null(AMOUNT),
            "claims_checked": COUNT,
            "faults": list_of(TEXT),
            "on_front": FLAG,
            "tree_bytes": COUNT,
            "build_seconds": AMOUNT,
        },
    )
    return (
        _SETTING
        | _answered("status", "time", "time_bounds", "evidence", "distance", "approximate")
        | {
            "error_bound": told(or_null(AMOUNT), "mesh units; null beyond the largest double"),
            "verdict_wrong": told(FLAG, "whether it says contact where there is none, or none"),
            "box_tests": COUNT,
            "triangle_tests": COUNT,
            "warm_seconds": told(record(_timing()), "s a call"),
        }
        | measured
    )


def stability() -> Schema:
    """Return the schema of `obbtree stability`."""
    result = {
        "ask": told(word_of(ASKS), "which question; no key where it is first-contact"),
        "answer": told(studied_answer(), "To the question itself."),
        "extreme_count": told(COUNT, "how many extremes there were to try"),
        "tried_count": told(COUNT, "how many were tried"),
        "broken_count": told(COUNT, "how many did not hold: should be 0"),
        "interrupted": told(FLAG, "whether Ctrl-C ended it"),
        "families": list_of(record(_FAMILY)),
        "rows": told(
            list_of({"anyOf": [record(_extreme()), record(_rest_extreme())]}), "one an extreme"
        ),
    }
    return pair_document(
        "stability", record(result, optional=("ask",)), stats=record({"seconds": SECONDS})
    )


_FAMILY = {
    "family": told(TEXT, "what was changed"),
    "tried_count": COUNT,
    "outcomes": record(dict.fromkeys(get_args(Outcome), COUNT)),
    "same_bits_end_at": told(or_null(TEXT), "the first extreme that gave other bits"),
    "why": told(or_null(TEXT), "what they come from"),
}


def _extreme() -> dict[str, Schema]:
    """Return the fields of an extreme."""
    beyond = "; null beyond the largest double"
    fields = documented(
        Row,
        {
            "family": TEXT,
            "extreme": TEXT,
            "magnitude": or_null(NUMBER),
            "expected": word_of(("same bits", "within bound", "proven")),
            "bound": or_null(AMOUNT),
            "why": TEXT,
            "status": or_null(STATUS),
            "time_bounds": or_null(TIME_BOUNDS),
            "difference": or_null(AMOUNT),
            "outcome": word_of(get_args(Outcome)),
            "held": FLAG,
            "reason": TEXT,
        },
    )
    for name in ("magnitude", "bound"):
        fields[name] = told(fields[name], fields[name].get("description", "") + beyond)
    return fields


def _rest_extreme() -> dict[str, Schema]:
    """Return the fields of an extreme of a question about t = 0."""
    brackets = table_of(tuple_of(AMOUNT, or_null(AMOUNT)), "by the names of the numbers")
    more = documented(
        RestRow,
        {
            "difference": or_null(AMOUNT),
            "relation": or_null(word_of(get_args(RelationWord))),
            "bounds": brackets,
        },
    )
    return _extreme() | more


def studied_answer() -> Schema:
    """Return the schema of an answer that a study is about."""
    of_distance = {
        "distance": told(AMOUNT, "mesh units; the upper one of bounds"),
        "bounds": told(tuple_of(AMOUNT, AMOUNT), "mesh units; both proven"),
        "complete": FLAG,
    }
    contact = record(CONTACT_FIELDS | PART_NAMES, optional=PART_NAMES)
    return {"anyOf": [contact, record(of_distance), record(overlap_fields())]}


def _answered(*names: str) -> dict[str, Schema]:
    return {name: CONTACT_FIELDS[name] for name in names}
