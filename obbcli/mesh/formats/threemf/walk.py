"""Goes through a model part of a 3MF archive: each element known, passed over or refused."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from obbcli.mesh.formats.safe_xml import XmlStream
from obbcli.mesh.formats.text import shown
from obbcli.mesh.formats.threemf.model import (
    CORE,
    INSIDE,
    PRODUCTION,
    READ,
    SLICES,
    TRIANGLE_SETS,
    UNIT_NAMES,
    Model,
    NoNumberError,
    Object,
    Placement,
    index,
    matrix_of,
    number,
)
from obbcli.mesh.formats.threemf.runs import Run, cut_at_ends, indices_of, numbers_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from obbcli.mesh.formats.threemf.archive import Archive
    from obbcli.mesh.source import Source

#: Where elements of extensions change nothing of the surface.
_FREE = {"model", "resources", "basematerials", "metadatagroup", "item", "metadata", "base"}
_AGAIN = "export it again"
#: Lists that may be long, and what stands in them.
_LISTS = {"vertices": "vertex", "triangles": "triangle"}
_LIST = re.compile(rb"<(?:vertices|triangles)>")


def walked(source: Source, archive: Archive, part: str, at: str) -> Model:
    """Return what a model part holds.

    Args:
        source: the file.
        archive: of it.
        part: the model part's name.
        at: what asks for it.

    Raises:
        MeshError: no whole XML, an element or extension that is not read, a word that is no
            number, an index out of range.
    """
    return _Walk(source, archive, part).run(at)


class _Walk:
    """Takes the elements of one part."""

    def __init__(self, source: Source, archive: Archive, part: str) -> None:
        self._archive = archive
        self._model = Model(part)
        self._stream = XmlStream(source, part)
        self._path = [""]
        self._skipped = 0
        self._object = Object("", "", 0)
        self._prefixes: dict[str, str] = {}
        self._defaults: set[str] = set()
        self._is_odd = False
        self._error = self._stream.error
        self._takes = {
            "model": self._take_model,
            "object": self._take_object,
            "component": self._take_component,
            "item": self._take_item,
            "vertex": self._take_vertex,
            "triangle": self._take_triangle,
        }

    def run(self, at: str) -> Model:
        """Walk through all of it."""
        parser = self._stream.parser
        parser.StartNamespaceDeclHandler = self._take_prefix
        parser.StartCdataSectionHandler = self._see_odd
        pieces = cut_at_ends(self._archive.pieces(self._model.part, at))
        self._stream.run(self._for_expat(pieces), self._start, self._end)
        return self._model

    def _for_expat(self, pieces: Iterable[bytes]) -> Iterator[bytes]:
        """Yield what expat is to read; what `Run` takes out leaves the ends of its lines."""
        given = 0
        for piece in pieces:
            rest = piece
            while rest:
                # Between two tokens of a list, and not within one that goes on, as comments do.
                is_between = self._stream.parser.CurrentByteIndex == given
                kind = _LISTS.get(self._path[-1]) if is_between and self._is_plain() else None
                size, text = self._take_run(rest, kind) if kind else (0, b"")
                if not size:
                    found = _LIST.search(rest)
                    size = found.end() if found else len(rest)
                    text = rest[:size]
                rest = rest[size:]
                given += len(text)
                yield text

    def _is_plain(self) -> bool:
        """Return whether names without a prefix are those of 3MF, and nothing odd was seen."""
        return not (self._is_odd or self._skipped) and self._defaults == {CORE}

    def _take_run(self, text: bytes, kind: str) -> tuple[int, bytes]:
        """Take vertices or triangles at the beginning of a text.

        Returns:
            How many bytes were taken, and the ends of lines in them.
        """
        run = Run(text, kind)
        if kind == "vertex":
            words = run.words((b"x", b"y", b"z"))
            numbers = None if words is None else numbers_of(words)
            if numbers is None:
                return 0, b""
            self._object.numbers.frombytes(numbers.tobytes())
        else:
            words = run.words((b"v1", b"v2", b"v3"))
            count = len(self._object.numbers) // 3
            corners = None if words is None else indices_of(words, count)
            if corners is None:
                return 0, b""
            self._object.corners.frombytes(corners.tobytes())
        return run.size, run.line_ends

    def _see_odd(self) -> None:
        self._is_odd = True

    def _take_prefix(self, prefix: str | None, uri: str | None) -> None:
        self._prefixes.setdefault(prefix or "", uri or "")
        if prefix is None:
            # One that is first met below the root holds for a part of the text alone.
            self._is_odd = self._is_odd or (len(self._path) > 1 and not self._defaults)
            self._defaults.add(uri or "")

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        space, _, local = name.rpartition(" ")
        parent = self._path[-1]
        if self._skipped or (space != CORE and parent != ""):
            if not self._skipped:
                self._pass_over(space, local, parent)
            self._skipped += 1
            return
        if space != CORE or local not in INSIDE.get(parent, ()):
            fault = f"<{shown(local.encode())}> is nothing that <{parent or '3MF'}> has"
            raise self._error(fault, _AGAIN)
        self._path.append(local)
        take = self._takes.get(local)
        if take is not None:
            try:
                take(attributes)
            except NoNumberError as fault:
                raise self._error(str(fault), _AGAIN) from fault
            except KeyError as fault:
                raise self._error(f"<{local}> has no attribute {fault}", _AGAIN) from fault

    def _end(self, _: str) -> None:
        if self._skipped:
            self._skipped -= 1
        else:
            self._path.pop()

    def _pass_over(self, space: str, local: str, parent: str) -> None:
        """Pass over an element of an extension, or keep that it may make surface."""
        if parent in _FREE or parent in ("vertex", "triangle") or space == TRIANGLE_SETS:
            return
        if "object" not in self._path:
            raise self._error(f"<{shown(local.encode())}> is not read", "export plain meshes")
        self._object.unread = self._object.unread or (local, self._stream.line)

    def _take_model(self, attributes: dict[str, str]) -> None:
        for prefix in attributes.get("requiredextensions", "").split():
            uri = self._prefixes.get(prefix, "")
            if uri not in READ:
                words = f"'{shown(prefix.encode())}' ({shown(uri.encode()) or 'not declared'})"
                raise self._error(f"requires the extension {words}", "export it without")
        unit = attributes.get("unit", "millimeter")
        if unit not in UNIT_NAMES:
            known = ", ".join(UNIT_NAMES)
            raise self._error(f"the unit is '{shown(unit.encode())}'", f"known are {known}")
        self._model.unit = UNIT_NAMES[unit]

    def _take_object(self, attributes: dict[str, str]) -> None:
        key = attributes["id"].strip()
        if key in self._model.objects:
            raise self._error(f"there are two objects {shown(key.encode())}", _AGAIN)
        kind = attributes.get("type", "model")
        self._object = Object(attributes.get("name", ""), kind, self._stream.line)
        self._model.objects[key] = self._object
        if attributes.get(f"{SLICES} meshresolution", "fullres") != "fullres":
            self._object.unread = ("slicestack", self._stream.line)

    def _take_component(self, attributes: dict[str, str]) -> None:
        self._object.components.append(self._placement(attributes))

    def _take_item(self, attributes: dict[str, str]) -> None:
        self._model.items.append(self._placement(attributes))

    def _placement(self, attributes: dict[str, str]) -> Placement:
        path, line = attributes.get(f"{PRODUCTION} path", ""), self._stream.line
        if path:
            path = self._archive.name_of(path, f"{self._model.part}, line {line}")
        matrix = matrix_of(attributes.get("transform"))
        return Placement(attributes["objectid"].strip(), path, matrix, line)

    def _take_vertex(self, attributes: dict[str, str]) -> None:
        self._object.numbers.extend(number(attributes[name]) for name in ("x", "y", "z"))

    def _take_triangle(self, attributes: dict[str, str]) -> None:
        count = len(self._object.numbers) // 3
        self._object.corners.extend(index(attributes[name], count) for name in ("v1", "v2", "v3"))
