"""Schemas of what questions about two bodies, and about scenes, answer."""

from __future__ import annotations

from obbcli.answers.collision import Collision
from obbcli.answers.distance import Distance
from obbcli.report.schema.relations import relation_fields
from obbcli.report.schema.shared import (
    CONTACT_FIELDS,
    COUNTERS,
    LATER_COUNTERS,
    PART_NAMES,
    PATH_FIELDS,
    RIGID_FIELDS,
    SECONDS,
    STATUS,
    document,
    pair_document,
)
from obbcli.report.schema.words import (
    AMOUNT,
    COUNT,
    FLAG,
    TEXT,
    VECTOR,
    Schema,
    documented,
    list_of,
    or_null,
    record,
    ref,
    told,
    tuple_of,
    word_of,
)
from obbcli.scene.results import BodyStats, SceneContact, SceneStats

_PAIR_OF_TRIANGLES = tuple_of(COUNT, COUNT)
_SOLID = told(FLAG, "whether a body inside the other counts as contact")
_FATES = ("static", "ignored", "apart_by_bounds", "apart_by_trees", "in_contact", "unresolved")


def collide() -> Schema:
    """Return the schema of `obbtree collide`."""
    fields = documented(
        Collision,
        {
            "status": STATUS,
            "collides": told(or_null(FLAG), "whether they touch; null where unresolved"),
            "witness": or_null(_PAIR_OF_TRIANGLES),
            "approximate": FLAG,
            "error_bound": AMOUNT,
            "contained": or_null(word_of(("a", "b"))),
        },
    )
    pairs = {
        "pairs": told(list_of(_PAIR_OF_TRIANGLES), "row of A, row of B, sorted; with --all-pairs"),
        "pairs_complete": told(FLAG, "whether these are all"),
    }
    more = pairs | PART_NAMES | relation_fields()
    return pair_document("collide", record(fields | more, optional=more), solid=_SOLID)


def first_contact() -> Schema:
    """Return the schema of `obbtree first-contact`."""
    listed = {
        "contacts": told(list_of(ref("contact")), "earliest first; with --all-contacts, --limit"),
        "contacts_complete": told(FLAG, "whether these are all"),
        "contacts_unresolved_after": told(
            or_null(AMOUNT), "s; where a limit ended the list: all contacts before it are there"
        ),
    }
    released = {
        "released": told(
            or_null(tuple_of(AMOUNT, AMOUNT)),
            "s; when they were apart first; null: never; with --after-release",
        ),
        "released_by": told(AMOUNT, "mesh units; apart by more than this; with --after-release"),
    }
    more = listed | released | PART_NAMES
    result = record(CONTACT_FIELDS | more, optional=more)
    return pair_document("first-contact", result, solid=_SOLID)


def distance() -> Schema:
    """Return the schema of `obbtree distance`."""
    fields = documented(
        Distance,
        {
            "distance": AMOUNT,
            "bounds": tuple_of(AMOUNT, AMOUNT),
            "point_a": VECTOR,
            "point_b": VECTOR,
            "triangle_a": COUNT,
            "triangle_b": COUNT,
        },
    )
    ended = told(FLAG, "whether the search ended before a limit")
    result = record(fields | {"complete": ended} | PART_NAMES, optional=PART_NAMES)
    return pair_document("distance", result)


def scene() -> Schema:
    """Return the schema of `obbtree scene`."""
    inputs = record(
        {"scene": ref("source"), "meshes": told(list_of(ref("source")), "of the bodies, each once")}
    )
    schema = document(
        "scene",
        inputs,
        duration=told(AMOUNT, "s"),
        bodies=moving_bodies(),
        ignore=list_of(IGNORE),
        accuracy=ref("accuracy"),
        solid=told(FLAG, "whether a body inside another counts as contact; no key where not"),
        result=_scene_result(),
        stats=scene_stats(),
    )
    schema["required"].remove("solid")
    return schema


IGNORE = {
    "oneOf": [
        record({"bodies": told(list_of(TEXT, 2), "the names of two bodies")}),
        record({"groups": told(list_of(TEXT), "of bodies in this group, or in these two")}),
    ]
}


BODY_FIELDS: dict[str, Schema] = {
    "name": TEXT,
    "mesh": told(COUNT, "which of inputs.meshes"),
    "static": told(FLAG, "whether pairs of static bodies are left out"),
    "group": or_null(TEXT),
}


def moving_bodies() -> Schema:
    """Return the schema of a scene's bodies, where they are and how they move."""
    return list_of({"oneOf": [_body(RIGID_FIELDS), _body(PATH_FIELDS)]})


def _body(movement: dict[str, Schema]) -> Schema:
    return record(BODY_FIELDS | movement)


def _scene_result() -> Schema:
    names = documented(SceneContact, {"body_a": TEXT, "body_b": TEXT})
    open_pair = names | {"time": told(AMOUNT, "s; nothing is known of the pair after it")}
    contact = record(names | CONTACT_FIELDS | PART_NAMES, optional=PART_NAMES)
    return record(
        {
            "status": STATUS,
            "time": told(or_null(AMOUNT), "s; of the earliest contact"),
            "approximate": told(FLAG, "whether any contact, or being apart, is not proven"),
            "contacts": told(list_of(contact), "earliest first"),
            "contacts_complete": told(FLAG, "whether these are all"),
            "unresolved": told(list_of(record(open_pair)), "pairs that a limit left open"),
            "interrupted": told(FLAG, "whether Ctrl-C ended the search"),
        }
    )


def scene_stats() -> Schema:
    """Return the schema of what became of a scene's pairs, and what it took."""
    counts = dict.fromkeys(("pairs", *_FATES, "later", *COUNTERS), COUNT)
    body = documented(
        BodyStats,
        {
            "name": TEXT,
            "triangle_count": or_null(COUNT),
            "triangles_loaded": COUNT,
            "nodes_built": COUNT,
            "nodes_possible": or_null(COUNT),
        },
    )
    others = {"bodies": list_of(record(body)), "seconds": SECONDS}
    decoded = {
        "meshes_decoded": told(COUNT, "of a mesh file's own, where that is the scene"),
        "meshes_possible": told(COUNT, "how many that file has; its parts are copies of them"),
    }
    optional = (*decoded, *LATER_COUNTERS)
    return record(documented(SceneStats, counts | others) | decoded, optional=optional)
