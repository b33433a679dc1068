"""What of a section of bulk data is no card that is read: passed over, told, or refused by name."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from obbcli.mesh.formats.nastran import cards as known
from obbcli.mesh.formats.nastran.fields import field_table
from obbcli.mesh.formats.nastran.lines import COLUMNS, HEAD, OTHER
from obbcli.mesh.formats.text import shown

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from obbcli.mesh.formats.nastran.deck import Deck
    from obbcli.mesh.formats.nastran.lines import Cards, Lines

#: Columns in which a fixed line may name the line that continues it.
_TAIL = 72


def check_names(deck: Deck, lines: Lines, cards: Mapping[bytes, Cards]) -> None:
    """Refuse the cards that could make, place or scale surface and are not read.

    Raises:
        MeshError: the first line of such a card, with its name.
    """
    for name, group in cards.items():
        number = int(lines.numbers[group.lines[0]])
        reason = known.REFUSED.get(name[:1] if name[:1] in (b"=", b"/") else name)
        if reason:
            raise deck.error(
                number,
                f"{shown(name)} {reason}",
                "export the model as plain shells and solids, or take the card out",
            )
        if known.is_read(name):
            _check_beginning(deck, lines, name, group)
        elif name not in known.TOLD and not known.is_passed_over(name):
            raise deck.error(
                number,
                f"{shown(name)} is no card that is known here, and it could make surface",
                "take it out of the deck if it makes, moves and copies none",
            )
    _check_superelements(deck, lines, cards)


def tell_of(deck: Deck, cards: list[Mapping[bytes, Cards]]) -> None:
    """Note what is passed over although it stands for a body, or changes surface."""
    counts: dict[str, list[str]] = {}
    for name, words in known.TOLD.items():
        count = sum(len(group[name].lines) for group in cards if name in group)
        if count:
            counts.setdefault(words, []).append(f"{count} {name.decode('ascii')}")
    for words, names in counts.items():
        deck.note(words.format(", ".join(names)))


def _check_beginning(deck: Deck, lines: Lines, name: bytes, group: Cards) -> None:
    """Refuse a card that is read where something stands between its name and its first field."""
    fixed = group.lines[lines.kinds[group.lines] != OTHER]
    letters = lines.columns(fixed, len(name), HEAD - len(name))
    letters[letters == ord("*")] = ord(" ")
    filled = np.flatnonzero((letters != ord(" ")).any(axis=1))
    if len(filled):
        line = int(fixed[filled[0]])
        raise deck.error(
            int(lines.numbers[line]),
            f"has '{shown(lines.content(line)[:HEAD])}' in its first eight columns, "
            f"expected {name.decode('ascii')}",
            "put fields into columns 9 to 16, 17 to 24 and so on, or separate them by commas",
        )


def _check_superelements(deck: Deck, lines: Lines, cards: Mapping[bytes, Cards]) -> None:
    """Refuse superelements that are copies or stand in other files, and rigid contact surfaces."""
    if known.SUPERELEMENT in cards:
        group = cards[known.SUPERELEMENT]
        kinds = field_table(deck, lines, group, 2)[:, 1]
        for line, kind in zip(group.lines, kinds.tolist(), strict=True):
            if kind.strip() not in (b"", known.PRIMARY):
                raise deck.error(
                    int(lines.numbers[line]),
                    f"SEBULK makes a superelement of type {shown(kind.strip())}, which is a copy "
                    "or stands in another file",
                    "export the model as one structure",
                )
    if known.CONTACT_BODY in cards:
        group = cards[known.CONTACT_BODY]
        for line, more in zip(group.lines.tolist(), group.more.tolist(), strict=True):
            card = b" ".join(lines.contents(np.arange(line, line + more + 1)))
            words = card.replace(b",", b" ").split()
            if any(word.startswith(known.RIGID_SHAPES) for word in words[1:]):
                raise deck.error(
                    int(lines.numbers[line]),
                    "BCBODY describes a rigid surface of patches or curves, which is not read",
                    "give the surface as shells",
                )


def check_continuations(deck: Deck, lines: Lines) -> None:
    """Refuse lines that continue another card than the one they follow.

    In a deck that is not sorted, a line names the one that continues it: `+A` in its last field,
    and in the first field of the other. Where the line before names something else, or nothing
    while some other line does name it, the card is elsewhere.

    Raises:
        MeshError: such a line, or one that begins with a blank and the name of a card.
    """
    rows = np.arange(len(lines))
    head = lines.columns(rows, 0, HEAD)
    first = head[:, 0]
    named = (head[:, 1:] != ord(" ")).any(axis=1)
    _check_indented(deck, lines, rows[np.isin(first, (ord(" "), ord("\t"))) & named])
    continuing = rows[np.isin(first, (ord("+"), ord("*"))) & named]
    wrong = []
    # In fixed fields most names are equal, letter by letter.
    tails = lines.columns(continuing - 1, _TAIL, HEAD)
    equal = (tails[:, 1:] == head[continuing, 1:]).all(axis=1)
    for row in continuing[~(equal & (lines.kinds[continuing] != OTHER))].tolist():
        own, before = _own_name(lines, row), _next_name(lines, row - 1)
        if own and own != before[1:]:
            wrong.append((row, own, before))
    if not wrong:
        return
    given = {_next_name(lines, row)[1:] for row in rows.tolist()}
    for row, own, before in wrong:
        # What stands last without a sign may be no name: serial numbers stand there as well.
        if own in given or (before[:1] in (b"+", b"*") and before[1:]):
            raise deck.error(
                int(lines.numbers[row]),
                f"'{shown(own)}' continues another line than the one before it",
                "sort the deck, so that each card's lines follow one another",
            )


def _check_indented(deck: Deck, lines: Lines, rows: NDArray[np.int64]) -> None:
    """Refuse a line that would continue the card before it, but begins with a card's name."""
    for row in rows.tolist():
        word = lines.content(row)[:COLUMNS].replace(b",", b" ").replace(b"*", b" ").split()[0]
        if known.is_read(word) or word in known.REFUSED or word in known.TOLD:
            raise deck.error(
                int(lines.numbers[row]),
                f"begins with blanks, so that {shown(word)} would continue the line before it",
                "begin the card in the first column",
            )


def _own_name(lines: Lines, row: int) -> bytes:
    """Return what a line that continues another calls itself, without its sign."""
    text = lines.content(row)
    return text[1:].partition(b",")[0].expandtabs(HEAD)[: HEAD - 1].strip()


def _next_name(lines: Lines, row: int) -> bytes:
    """Return what a line calls the one that continues it, with its sign or first letter."""
    text = lines.content(row)
    if b"," not in text:
        return text.expandtabs(HEAD)[_TAIL:COLUMNS].strip()
    items = [item.strip() for item in text.split(b",")]
    most = 5 if b"*" in items[0] else 9
    if len(items) > most:
        return items[most]
    return items[-1] if items[-1][:1] == b"+" else b""
