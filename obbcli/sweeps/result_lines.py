"""Rows in, lines of results out: what a thread pool or a worker of a cluster does with a chunk."""

from __future__ import annotations

import json
from collections import Counter
from typing import TYPE_CHECKING, Any, NamedTuple

from obbcli.errors import ObbError
from obbcli.sweeps.answer_rows import as_results
from obbcli.sweeps.row_questions import answer_questions, question_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from obbcli.questions.pair_question import Trees
    from obbcli.sweeps.row_fields import Row
    from obbcli.sweeps.row_questions import RowQuestion, SweepSetting

ERROR = "error"
"""How tallies count rows that ask nothing, beside the words of statuses."""
# Made once: json.dumps would make one a row.
_encode = json.JSONEncoder(allow_nan=False).encode
SAMPLED = "separated as sampled"
"""How they count rows that are separated, but not proven to be."""


class Block(NamedTuple):
    """The results of consecutive rows.

    Attributes:
        lines: one a row, each with its end.
        row_count: how many they are.
        tally: how many of them have which status.
    """

    lines: bytes
    row_count: int
    tally: Mapping[str, int]


def answer_rows(trees: Trees, rows: Sequence[Row], setting: SweepSetting, threads: int) -> Block:
    """Return the results of some rows, the same whatever the number of threads.

    Raises:
        TreeFileError: a tree file is damaged.
    """
    results: list[dict[str, Any]] = [{}] * len(rows)
    asked: list[tuple[int, RowQuestion]] = []
    for index, row in enumerate(rows):
        try:
            if row.error is not None:
                raise row.error
            asked.append((index, question_of(row.values, setting, row.where)))
        except ObbError as refusal:
            results[index] = error_part(refusal)
    outcome = answer_questions(trees, [question for _, question in asked], setting, threads)
    for place, ((index, _), answer) in enumerate(
        zip(asked, as_results(outcome.answers, trees), strict=True)
    ):
        fault = outcome.errors.get(place)
        if fault is None:
            results[index] = answer
        else:
            place_of = f"{rows[index].where}, {fault.where}"
            results[index] = error_part(ObbError(place_of, fault.fault, fault.remedy))
    lines = [line_of(row, result) for row, result in zip(rows, results, strict=True)]
    tally = Counter(tallied(result) for result in results)
    return Block("".join(lines).encode(), len(rows), dict(tally))


def error_part(fault: ObbError) -> dict[str, Any]:
    """Return why a row has no answer, as the results have it."""
    return {ERROR: {"where": fault.where, "fault": fault.fault, "remedy": fault.remedy}}


def tallied(result: Mapping[str, Any]) -> str:
    """Return what a row of the results is counted as."""
    if ERROR in result:
        return ERROR
    status = str(result["status"])
    return SAMPLED if status == "separated" and result["approximate"] else status


def line_of(row: Row, result: Mapping[str, Any]) -> str:
    """Return a row of the results."""
    return _encode({"row": row.number, "id": row.identity, **result}) + "\n"
