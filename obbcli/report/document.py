"""A record as its JSON document."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from obbcli.report.record import Record


def to_json(record: Record) -> str:
    """Return the document as one line of ASCII that ends in a newline.

    Numbers round-trip, keys keep the record's order, and every string is legal in any encoding.

    Raises:
        ValueError: a NaN or an infinity got into the record.
    """
    return json.dumps(record, allow_nan=False) + "\n"
