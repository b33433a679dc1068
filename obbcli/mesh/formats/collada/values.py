"""Numbers and links in elements of COLLADA."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from obbcli.mesh.formats.text import all_numbers, all_whole, shown, whole

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from obbcli.errors import MeshError
    from obbcli.mesh.formats.safe_xml import Element
    from obbcli.mesh.source import Source

AGAIN = "export it again"
_MOST = 1 << 53


class Values:
    """Takes numbers out of elements; every method raises `MeshError` with the element's line.

    Args:
        source: the file.
    """

    def __init__(self, source: Source) -> None:
        self.source = source

    def error(self, element: Element, fault: str, remedy: str = AGAIN) -> MeshError:
        """Return an error at an element."""
        return self.source.error(fault, remedy, at=str(element.line))

    def numbers(self, element: Element, count: int | None = None) -> NDArray[np.float64]:
        """Return the finite numbers that an element lists, so many where that is known."""
        words = element.text.encode().split()
        values = None if "_" in element.text else all_numbers(words)
        if values is None:
            bad = next((word for word in words if not _is_number(word)), b"")
            raise self.error(element, f"'{shown(bad)}' in <{element.name}> is not a finite number")
        if count is not None and len(values) != count:
            fault = f"<{element.name}> has {len(values)} numbers, expected {count}"
            raise self.error(element, fault)
        return values

    def indices(self, element: Element) -> NDArray[np.int64]:
        """Return the whole numbers that an element lists."""
        words = element.text.encode().split()
        values = None if "_" in element.text else all_whole(words)
        if values is None or (len(values) and not 0 <= values.min() <= values.max() < _MOST):
            for word in words:
                if not 0 <= whole(self.source, word, element.line, "index") < _MOST:
                    raise self.error(element, f"index {shown(word)} is out of range")
        assert values is not None
        return values

    def count(self, element: Element, name: str, missing: int | None = None) -> int:
        """Return a whole number at least 0 that an attribute holds.

        Args:
            element: that has it.
            name: the attribute's.
            missing: what it is where it does not stand; None if it must.
        """
        word = element.get(name)
        if not word and missing is not None:
            return missing
        value = whole(self.source, word.encode(), element.line, f"{name} of <{element.name}>")
        if not 0 <= value < _MOST:
            raise self.error(element, f"{name} of <{element.name}> is {value}")
        return value

    def link(self, element: Element, name: str) -> str:
        """Return the id that an attribute links to, within the file."""
        word = element.get(name).strip()
        if not word.startswith("#") or len(word) == 1:
            spelled = shown(word.encode())
            fault = f"<{element.name}> links to '{spelled}', which is not in this file"
            raise self.error(element, fault, "bring all into one file")
        return word[1:]


def _is_number(word: bytes) -> bool:
    try:
        return b"_" not in word and math.isfinite(float(word))
    except ValueError:
        return False
