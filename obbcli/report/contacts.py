"""The list of contacts in the record of `obbtree first-contact`, and its table."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, NamedTuple

from obbcli.answers.contact import Contact
from obbcli.report.record import part_names
from obbcli.report.table import Table, count, point

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from obbcli.report.record import Record, Source

_COLUMNS = ("time [s]", "triangle of A", "triangle of B", "feature", "point")
_IDS = ("triangle_a", "triangle_b")


class Listing(NamedTuple):
    """Contacts that were listed.

    Attributes:
        contacts: in order of time.
        is_complete: whether these are known to be all.
        unresolved_after: s; where a limit ended the list: all contacts before it are there.
    """

    contacts: Sequence[Contact]
    is_complete: bool
    unresolved_after: float | None = None


def contacts_part(listing: Listing, sources: Sequence[Source]) -> Record:
    """Return what a result says of a list about the files of A and B."""
    return {
        "contacts": [contact_part(contact, sources) for contact in listing.contacts],
        "contacts_complete": listing.is_complete,
        "contacts_unresolved_after": listing.unresolved_after,
    }


_FIELDS = [field.name for field in fields(Contact) if field.name not in ("part_a", "part_b")]


def contact_part(contact: Contact, sources: Iterable[Source]) -> Record:
    """Return what a record says of a contact.

    Args:
        contact: which may be an answer of more fields, of which it says nothing.
        sources: the files of A and B.
    """
    values = {name: getattr(contact, name) for name in _FIELDS}
    return values | {"status": contact.status.value} | part_names(contact, sources)


def contacts_table(result: Record) -> Table:
    """Return the table of a list, a row a contact."""
    contacts = result["contacts"]
    title = f"pairs that touch: {count(len(contacts))}, earliest first{open_end(result)}"
    rows = [
        (
            repr(contact["time"]),
            *_pair(contact),
            contact["feature"] or "",
            "" if contact["point"] is None else point(contact["point"]),
        )
        for contact in contacts
    ]
    return Table(rows, _COLUMNS, title)


def contacts_bare(result: Record) -> str:
    """Return a line a contact: its time and its two triangles."""
    return "".join(
        " ".join((repr(contact["time"]), *_pair(contact))) + "\n" for contact in result["contacts"]
    )


def open_end(result: Record) -> str:
    """Return what is to be added to a list that may not be all; nothing where it is."""
    after = result["contacts_unresolved_after"]
    if after is not None:
        return f"; a limit was reached: complete only before t = {after!r} s"
    return "" if result["contacts_complete"] else "; more may follow: see --limit"


def _pair(contact: Record) -> tuple[str, str]:
    """Return the rows of two triangles; boxes that stand for triangles have none."""
    a, b = ("-" if contact[name] is None else str(contact[name]) for name in _IDS)
    return a, b
