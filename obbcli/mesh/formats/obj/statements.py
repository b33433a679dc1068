"""The statements of Wavefront OBJ: which carry no surface, which are refused, and other lines.

Lines that are no statement stand in files that everybody uses: the pair of meshes that FCL and coal
test with begins with two counts, VTK's cow with a thank-you. Such a line is passed over and told;
one that could have been a corner or a face is refused.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from obbcli.mesh.formats.text import counted, shown, strip_mark

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.errors import MeshError
    from obbcli.mesh.source import Source

#: Statements that place no polygon: attributes, grouping, points and lines, settings of free-form
#: curves and surfaces (which are refused where they are made), appearance, materials.
PASSED_OVER = frozenset(
    b"vt vn vp vc p l g o s mg usemtl mtllib usemap maplib bevel c_interp d_interp lod shadow_obj "
    b"trace_obj ctech stech cstype deg bmat step parm trim hole scrv sp end con res "
    b"newmtl Ka Kd Ks Ke Ns Ni Tr Tf d illum bump refl norm decal disp".split()
)
_MAPS = b"map_"
_REFUSED = {
    b"curv": "free-form curve",
    b"curv2": "free-form curve",
    b"surf": "free-form surface",
    b"bzp": "free-form surface (a Bezier patch)",
    b"bsp": "free-form surface (a B-spline patch)",
    b"cdp": "free-form surface (a Cardinal patch)",
    b"cdc": "free-form curve",
    b"call": "call of another file",
    b"csh": "shell command",
}
_CONFLICTS = (b"<<<<<<<", b">>>>>>>")
_NUMBER = re.compile(rb"[-+]?(\d+\.?\d*|\.\d+)([eEdD][-+]?\d+)?(/[-+\d/]*)?")
#: So many numbers make a corner, and so many corners a face.
_ENOUGH = 3


def is_passed_over(keyword: bytes) -> bool:
    """Return whether a statement places no polygon."""
    return keyword in PASSED_OVER or keyword.startswith(_MAPS)


def statements(data: bytes) -> Iterator[tuple[int, list[bytes]]]:
    """Yield line number and words of each statement, comments cut and continued lines joined."""
    held: list[bytes] = []
    first = 0
    for line, content in enumerate(strip_mark(data).splitlines(), start=1):
        if b"#" in content:
            content = content[: content.index(b"#")]
        words = content.split()
        if words and words[-1].endswith(b"\\"):
            first = first or line
            held += [*words[:-1], words[-1][:-1]] if words[-1] != b"\\" else words[:-1]
            continue
        if held:
            words, held, line, first = held + words, [], first, 0
        if words:
            yield line, words
    if held:
        yield first, held


class OtherLines:
    """Takes the lines of a file that are no statement and place no polygon.

    Args:
        source: the file, which is given the note.
    """

    def __init__(self, source: Source) -> None:
        self._source = source
        self._count = 0
        self._first = ""

    def meet(self, words: list[bytes], line: int, *, opens: bool) -> None:
        """Count a line that is no statement.

        Args:
            words: of the line.
            line: its number.
            opens: whether no statement stands before it.

        Raises:
            MeshError: it could be part of the shape, or shows that the file is damaged.
        """
        keyword = words[0]
        if keyword in _REFUSED:
            raise self._refusal(
                line,
                f"'{shown(keyword)}' is a {_REFUSED[keyword]}, which is not read",
                "export the model as triangles",
            )
        if keyword.startswith(_CONFLICTS):
            fault = "is a merge conflict of git: the file holds two versions of the shape"
            raise self._refusal(line, fault, "settle the conflict")
        if not opens and _may_be_shape(words):
            raise self._refusal(
                line,
                f"'{shown(keyword)}' is no OBJ statement, but numbers follow it",
                "remove the line if it is no part of the shape",
            )
        if any(letter < 0x20 or letter == 0x7F for letter in keyword):
            raise self._refusal(
                line, f"'{shown(keyword)}' is no OBJ statement", "the file is damaged, or no OBJ"
            )
        self._first = self._first or f"the first is line {line}, '{shown(keyword)}'"
        self._count += 1

    def _refusal(self, line: int, fault: str, remedy: str) -> MeshError:
        return self._source.error(fault, remedy, at=str(line))

    def tell(self, *, has_faces: bool) -> None:
        """Write the note, if there is something to tell.

        Raises:
            MeshError: there are such lines and no faces.
        """
        if self._count:
            of = "that is no statement" if self._count == 1 else "that are no statements"
            what = f"{counted(self._count, 'line')} {of} of OBJ"
            if not has_faces:
                fault = f"has no faces, but {what}: {self._first}"
                raise self._source.error(fault, "it is no OBJ file, or another kind of one")
            self._source.note(f"{what} passed over: {self._first}")


def _may_be_shape(words: list[bytes]) -> bool:
    """Return whether a line may be a corner or a face of which the beginning was lost or spoilt."""
    numbers = [_NUMBER.fullmatch(word) is not None for word in words]
    return all(numbers) or (len(words) > _ENOUGH and all(numbers[1:]))
