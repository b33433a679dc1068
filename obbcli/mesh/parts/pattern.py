"""Patterns that select parts by their paths: shell wildcards over whole path elements.

`*`, `?`, `[abc]`, `[a-z]` and `[!a]` match within one element, an element `**` any number of them,
and a match takes all that stands below it. A backslash takes the sign after it as it is.
"""

from __future__ import annotations

from typing import NamedTuple, TypeAlias


class _OneOf(NamedTuple):
    """Stands for one letter that is in a set, or that is not."""

    ranges: tuple[tuple[str, str], ...]
    is_negated: bool

    def takes(self, letter: str) -> bool:
        """Return whether the letter is taken."""
        return any(low <= letter <= high for low, high in self.ranges) != self.is_negated


class _Sign(NamedTuple):
    """Stands for any letter (`?`) or for any letters (`*`)."""

    is_star: bool


_STAR, _ANY = _Sign(is_star=True), _Sign(is_star=False)
#: One element of a pattern: letters as they are, signs and sets.
_Element: TypeAlias = list["str | _Sign | _OneOf"]


class Pattern:
    r"""Selects paths.

    Args:
        text: as it is written, such as `arm/*/bolt[12]` or `**/screw\#2`.

    Example:
        >>> pattern = Pattern("robot/**/bolt*")
        >>> [pattern.takes(path) for path in ("robot/arm/bolt#2/head", "robot/arm/nut")]
        [True, False]
    """

    def __init__(self, text: str) -> None:
        self.text = text
        self._elements = _elements(text)

    def takes(self, path: str) -> bool:
        """Return whether a path, or one that it stands below, matches."""
        last = len(self._elements)
        # The numbers of elements that may be matched so far; `**` may stay where it is.
        states = self._beyond_stars({0})
        for name in path.split("/"):
            if last in states:
                return True
            reached = set()
            for state in states:
                element = self._elements[state]
                if element is None:
                    reached.add(state)
                elif _matches(element, name):
                    reached.add(state + 1)
            states = self._beyond_stars(reached)
        return last in states

    def _beyond_stars(self, states: set[int]) -> set[int]:
        """Return the states with those that `**` reaches by matching nothing."""
        found = set(states)
        for state in states:
            while state < len(self._elements) and self._elements[state] is None:
                state += 1
                found.add(state)
        return found


def _elements(text: str) -> list[_Element | None]:
    """Return the elements of a pattern, None for each `**`."""
    elements: list[_Element] = [[]]
    place = 0
    while place < len(text):
        letter = text[place]
        place += 1
        if letter == "\\" and place < len(text):
            letter = text[place]
            place += 1
            if letter != "/":
                elements[-1].append(letter)
                continue
        if letter == "/":
            elements.append([])
        elif letter == "*":
            elements[-1].append(_STAR)
        elif letter == "?":
            elements[-1].append(_ANY)
        elif letter == "[" and (found := _one_of(text, place)) is not None:
            one, place = found
            elements[-1].append(one)
        else:
            elements[-1].append(letter)
    return [None if element == [_STAR, _STAR] else element for element in elements]


def _one_of(text: str, place: int) -> tuple[_OneOf, int] | None:
    """Return the set that opens before `place`, and where it ends; None where it does not close."""
    is_negated = text[place : place + 1] in ("!", "^")
    place += is_negated
    letters: list[tuple[str, bool]] = []  # and whether a minus may make a range of it
    while place < len(text) and (text[place] != "]" or not letters):
        if text[place] == "/":
            return None
        is_escaped = text[place] == "\\" and place + 1 < len(text)
        place += is_escaped
        letters.append((text[place], is_escaped))
        place += 1
    if place >= len(text):
        return None
    ranges, k = [], 0
    while k < len(letters):
        is_range = k + 2 < len(letters) and letters[k + 1] == ("-", False)
        ranges.append((letters[k][0], letters[k + 2 if is_range else k][0]))
        k += 3 if is_range else 1
    return _OneOf(tuple(ranges), is_negated), place + 1


def _matches(element: _Element, name: str) -> bool:
    """Return whether an element matches a whole name; steps grow with the product of lengths."""
    at = place = 0
    star = resumes = -1
    while place < len(name):
        token = element[at] if at < len(element) else None
        if token == _STAR:
            star, resumes = at, place
            at += 1
        elif token is not None and _takes(token, name[place]):
            at += 1
            place += 1
        elif star >= 0:
            # The last star takes one letter more: earlier ones need not be tried again.
            resumes += 1
            at, place = star + 1, resumes
        else:
            return False
    return all(token == _STAR for token in element[at:])


def _takes(token: str | _Sign | _OneOf, letter: str) -> bool:
    if isinstance(token, str):
        return token == letter
    return token == _ANY if isinstance(token, _Sign) else token.takes(letter)


def escaped(path: str) -> str:
    """Return the pattern that matches a path and what stands below it."""
    return "".join(f"\\{letter}" if letter in "\\*?[" else letter for letter in path)
