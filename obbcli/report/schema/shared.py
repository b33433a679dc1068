"""Schemas of the parts that several documents share; a document holds those that it refers to."""

from __future__ import annotations

from obbcli.accuracy import Accuracy
from obbcli.answers.contact import Contact
from obbcli.answers.counts import Counts, QueryStats
from obbcli.answers.status import Status
from obbcli.mesh import PartRows
from obbcli.report.record import SCHEMA_VERSION
from obbcli.report.schema.typed import schemas_of
from obbcli.report.schema.words import (
    AMOUNT,
    COUNT,
    NUMBER,
    SHA256,
    TEXT,
    VECTOR,
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

STATUS = told(
    word_of(status.value for status in Status),
    "How the question ended. separated: no contact in the whole closed interval, proven unless "
    "approximate. contact: first contact at a time later than 0. overlap_at_start: contact at "
    "t = 0, touching included. unresolved: a limit was reached first.",
)
TIME_BOUNDS = tuple_of(AMOUNT, or_null(AMOUNT))
SECONDS = table_of(AMOUNT, "s of wall time by stage")

ACCURACY_FIELDS = schemas_of(Accuracy)
_CONTACT = schemas_of(Contact, status=STATUS)
PART_NAMES = {name: _CONTACT.pop(name) for name in ("part_a", "part_b")}
"""What an answer adds to its triangles where parts were selected: both keys or none."""
CONTACT_FIELDS = _CONTACT

# What every kind of search counts.
COUNTERS = Counts._fields
# Those that documents of earlier versions do not have.
LATER_COUNTERS = ("image_tests",)
STATS_FIELDS = documented(
    QueryStats,
    dict.fromkeys(
        (*COUNTERS, *(f"nodes_{which}_{side}" for which in ("built", "possible") for side in "ab")),
        COUNT,
    )
    | {"seconds": SECONDS},
)

_POSE = record(
    {
        "rotation": told(list_of(VECTOR, 3), "matrix, by rows"),
        "translation": told(VECTOR, "mesh units"),
    },
    description="x(0) = rotation p + translation",
)
RIGID_FIELDS = {
    "pose": ref("pose"),
    "linear_velocity": told(VECTOR, "mesh units a second, world frame"),
    "angular_velocity": told(VECTOR, "rad/s, world frame"),
    "pivot": told(VECTOR, "where the axis passes at t = 0, world coordinates"),
}
PATH_FIELDS = {
    "pose": ref("pose"),
    "times": told(list_of(NUMBER), "s, rising"),
    "poses": told(list_of(ref("pose")), "one a time; between two, both velocities are constant"),
}

_PART_ROWS = record(
    documented(PartRows, {"path": TEXT, "first_triangle": COUNT, "triangle_count": COUNT})
)

BUILD_FIELDS = {
    "fit": told(TEXT, "how boxes are fitted"),
    "split": told(TEXT, "how boxes are divided"),
    "leaf_size": told(COUNT, "triangles that a leaf holds at most"),
    "max_depth": told(or_null(COUNT), "the level at which no box is divided; null: none"),
}

DEFINITIONS: dict[str, Schema] = {
    "source": record(
        {
            "path": told(TEXT, "as it was written; - is standard input"),
            "sha256": told(or_null(SHA256), "of the file's bytes; null where they were not read"),
            "triangle_count": told(or_null(COUNT), "null where there is none to count"),
            "notes": told(list_of(TEXT), "what of it was taken with a change, a sentence each"),
            "unit": told(TEXT, "the length of 1; left out where neither file nor options state it"),
            "sag": told(AMOUNT, "how far triangles are from exact surfaces; else left out"),
            "parts": told(list_of(_PART_ROWS), "those that FILE#PATTERN selected; else left out"),
        },
        optional=("notes", "unit", "sag", "parts"),  # documents written before notes came have none
        description="A file that was asked about.",
    ),
    "accuracy": record(ACCURACY_FIELDS, description="The accuracy as used."),
    "stats": record(
        STATS_FIELDS,
        optional=LATER_COUNTERS,
        description="What the answer cost; not the same every time.",
    ),
    "contact": record(
        CONTACT_FIELDS | PART_NAMES,
        optional=PART_NAMES,
        description="When and where two triangles first touch.",
    ),
    "pose": _POSE,
    "rigid": record(RIGID_FIELDS, description="Constant linear and angular velocity."),
    "path": record(PATH_FIELDS, description="A path through given poses."),
    "body": {"oneOf": [ref("rigid"), ref("path")]},
    "motion": record(
        {
            "duration": told(AMOUNT, "s; asked about is 0 <= t <= duration"),
            "a": ref("body"),
            "b": ref("body"),
        },
        description="The motion as understood.",
    ),
    "build": record(BUILD_FIELDS, description="What shaped a tree."),
}

PAIR = record({"a": ref("source"), "b": ref("source")})


def document(name: str, inputs: Schema, **parts: Schema) -> Schema:
    """Return the schema of a document, its parts in the order given."""
    head: dict[str, Schema] = {
        "schema": {"const": f"obbtree/{name}/{SCHEMA_VERSION}"},
        "tool_version": told(TEXT, "of the obbtree that wrote it"),
        "inputs": inputs,
    }
    return record(head | parts)


def pair_document(
    name: str, result: Schema, *, stats: Schema | None = None, **parts: Schema
) -> Schema:
    """Return the schema of a document about A and B; `stats` are those of a query if not given."""
    return document(
        name,
        PAIR,
        motion=ref("motion"),
        accuracy=ref("accuracy"),
        **parts,
        result=result,
        stats=ref("stats") if stats is None else stats,
    )
