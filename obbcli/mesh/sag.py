"""The sag: how far triangles may be from the exact surfaces that they are cut from."""

from __future__ import annotations

from math import inf
from pathlib import Path
from typing import TYPE_CHECKING

from obbcli.errors import MeshError
from obbcli.files import file_of
from obbcli.mesh.formats import FORMATS, suffix_of
from obbcli.mesh.formats.sniff import HEAD_BYTES, beginning
from obbcli.mesh.source import read_head

if TYPE_CHECKING:
    from obbcli.mesh.source import Source

_NONE_EXACT = "holds triangles and no exact surfaces, which a sag would cut"


def checked_sag(sag: object) -> float:
    """Return a sag that can be cut with.

    Raises:
        MeshError: it is no finite number above 0.
    """
    if isinstance(sag, bool) or not isinstance(sag, (int, float)) or not 0.0 < sag < inf:
        raise MeshError("sag", f"is {sag!r}", "use a finite number above 0")
    return float(sag)


def has_exact_surfaces(name: str) -> bool:
    """Return whether a mesh file, or the one of `FILE#PATTERN`, is of a format that has them.

    Its name tells, or its beginning where it is no pipe.

    Raises:
        MeshError: it cannot be read.
    """
    path = Path(file_of(name))
    form = FORMATS.get(suffix_of(path.name))
    found = beginning(read_head(path, HEAD_BYTES).data)
    if found is not None and found.is_sure:
        form = FORMATS[found.suffix]
    return form is not None and form.is_exact


def no_exact_surfaces(source: Source) -> MeshError:
    """Return the error of a file that a sag has no effect on."""
    return source.error(_NONE_EXACT, "leave out the sag")
