"""`Section`: the lines and cards of one section of bulk data, and errors at them."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from obbcli.mesh.formats.nastran.fields import field_table
from obbcli.mesh.formats.text import shown

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from obbcli.mesh.formats.nastran.deck import Deck
    from obbcli.mesh.formats.nastran.lines import Cards, Lines


class Section(NamedTuple):
    """Holds what a section of bulk data is read from.

    Attributes:
        deck: whose lines errors name.
        lines: those of the section.
        cards: by their names.
    """

    deck: Deck
    lines: Lines
    cards: Mapping[bytes, Cards]

    def line_of(self, name: bytes, card: int) -> int:
        """Return the deck's line of a card of some name."""
        return int(self.lines.numbers[self.cards[name].lines[card]])

    def fields(self, name: bytes, count: int) -> NDArray[np.bytes_]:
        """Return the first fields of all cards of a name, (n, count)."""
        return field_table(self.deck, self.lines, self.cards[name], count)

    def refuse(
        self, name: bytes, words: NDArray[np.bytes_], wrong: NDArray[np.bool_], what: str
    ) -> None:
        """Refuse the first card in whose field stands something else than what is expected.

        Args:
            name: of the cards.
            words: the field of each, (n,).
            wrong: which are refused, (n,).
            what: what is expected.

        Raises:
            MeshError: one of them is wrong.
        """
        if wrong.any():
            card = int(np.argmax(wrong))
            raise self.deck.error(
                self.line_of(name, card),
                f"{name.decode('ascii')} has '{shown(words[card].strip())}', expected {what}",
                "correct the field, or its columns",
            )
