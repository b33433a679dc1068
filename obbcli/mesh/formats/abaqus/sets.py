"""Sets of nodes and elements of an Abaqus deck, read where a generation keyword names one."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from obbcli.mesh.formats.abaqus.sections import whole_word, write_out
from obbcli.mesh.formats.text import shown

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from obbcli.mesh.formats.abaqus.sections import Section

    #: The pieces that make up each set, by its name in capitals.
    Sets = Mapping[str, Sequence[NDArray[np.int64] | Section]]

#: How many sets may lie in one another.
_DEEPEST = 100
#: Most numbers that one line generates: a slip of a key must not fill the memory.
_MOST = 20_000_000


def members(
    sets: Sets,
    section: Section,
    line: str,
    name: bytes,
    known: dict[str, NDArray[np.int64] | None],
) -> NDArray[np.int64]:
    """Return the numbers of a set, sorted, or as they are written where it is UNSORTED.

    Args:
        sets: those defined so far.
        section: the keyword that names the set.
        line: where it does.
        name: of the set; a number stands for itself.
        known: sets found for the same keyword, which this adds to; None for those being found.

    Raises:
        MeshError: there is no such set, it contains itself, or it is defined in a way that is not
            read; with the line.
    """
    if name.isdigit():
        return np.array([whole_word(section, name, int(line), "number")], dtype=np.int64)
    key = name.decode("latin-1").upper()
    found = known.get(key)
    if found is not None:
        return found
    depth = sum(each is None for each in known.values())
    if key not in sets or key in known or depth > _DEEPEST:
        fault = f"*{section.keyword} names the set '{shown(name)}', which is not defined before it"
        raise section.source.error(fault, "define it by its numbers", at=line)
    known[key] = None
    pieces = [
        piece if isinstance(piece, np.ndarray) else _listed(sets, piece, known)
        for piece in sets[key]
    ]
    numbers = np.concatenate([np.zeros(0, dtype=np.int64), *pieces])
    numbers, first = np.unique(numbers, return_index=True)
    if any(not isinstance(p, np.ndarray) and "UNSORTED" in p.options for p in sets[key]):
        numbers = numbers[np.argsort(first)]
    known[key] = numbers
    return numbers


def _options(section: Section) -> set[str]:
    """Return the parameters of a set that are read, after those abbreviated are written out."""
    known = {section.keyword, "GENERATE", "UNSORTED", "INTERNAL"}
    write_out(section, known)
    return known


def _listed(
    sets: Sets, section: Section, known: dict[str, NDArray[np.int64] | None]
) -> NDArray[np.int64]:
    """Return the numbers that *NSET or *ELSET lists."""
    source = section.source
    if not _options(section).issuperset(section.options):
        fault = f"the set of *{section.keyword} is used to generate, and defined in a way not read"
        raise source.error(fault, "define it by its numbers", at=str(section.line))
    found = [np.zeros(0, dtype=np.int64)]
    for number, content in enumerate(section.data.split(b"\n"), start=section.first):
        words = [word for word in map(bytes.strip, content.split(b",")) if word]
        if words and "GENERATE" in section.options:
            bounds = [whole_word(section, word, number, "number") for word in words]
            first, last, step = [*bounds[:1], *bounds, 1][-3:] if len(bounds) < 3 else bounds[:3]
            if step < 1 or not 0 <= (last - first) // step < _MOST:
                raise source.error(f"no numbers from {first} to {last} by {step}", at=str(number))
            found.append(np.arange(first, last + 1, step, dtype=np.int64))
        else:
            found += [members(sets, section, str(number), word, known) for word in words]
    return np.concatenate(found)
