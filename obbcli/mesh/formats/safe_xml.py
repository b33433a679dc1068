"""XML of strangers: expat without document types, so that there are no entities to expand.

Nothing outside of the text is ever asked for: expat opens no files and knows no network.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NoReturn
from xml.parsers import expat

from obbcli.errors import MeshError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from obbcli.mesh.source import Source

    #: Takes the name of an element, `NAMESPACE LOCAL`, and its attributes.
    Start = Callable[[str, dict[str, str]], None]

#: Elements that stand in one another.
_DEEPEST = 200


class XmlStream:
    """Goes through the elements of a text piece by piece.

    Args:
        source: the file, which errors name.
        part: the member of an archive that is read; empty for the file itself.
    """

    def __init__(self, source: Source, part: str = "") -> None:
        self._source = source
        self._part = part
        self._depth = 0
        self.parser = expat.ParserCreate(namespace_separator=" ")
        self.parser.buffer_text = True
        self.parser.StartDoctypeDeclHandler = self._refuse
        self.parser.EntityDeclHandler = self._refuse

    @property
    def line(self) -> int:
        """The number of the line that is read."""
        return self.parser.CurrentLineNumber

    def error(self, fault: str, remedy: str = "", line: int | None = None) -> MeshError:
        """Return an error at a line, that which is read unless another is given."""
        number = str(self.line if line is None else line)
        at = f"{self._part}, line {number}" if self._part else number
        return self._source.error(fault, remedy, at=at)

    def run(self, pieces: Iterable[bytes], start: Start, end: Callable[[str], None]) -> None:
        """Read all of a text.

        Raises:
            MeshError: no whole XML, a document type, elements nested too deep, or what the
                handlers raise.
        """

        def opened(name: str, attributes: dict[str, str]) -> None:
            self._depth += 1
            if self._depth > _DEEPEST:
                raise self.error(f"nests deeper than {_DEEPEST} elements", "export it again")
            start(name, attributes)

        def closed(name: str) -> None:
            self._depth -= 1
            end(name)

        self.parser.StartElementHandler = opened
        self.parser.EndElementHandler = closed
        try:
            for piece in pieces:
                self.parser.Parse(piece, False)
            self.parser.Parse(b"", True)
        except MeshError:
            raise
        except expat.ExpatError as fault:
            words = expat.ErrorString(fault.code) or "damaged"
            remedy = "it was cut short or damaged"
            raise self.error(f"is no whole XML: {words}", remedy, fault.lineno) from fault
        except (ValueError, LookupError) as fault:
            remedy = "save it as UTF-8"
            raise self.error("has an encoding that is not known", remedy, 1) from fault

    def _refuse(self, *_: Any) -> NoReturn:
        raise self.error("declares a document type", "remove the <!DOCTYPE ...>")


class Element:
    """Holds an element of a document.

    Attributes:
        name: without its namespace.
        attributes: as they stand; names of a namespace are `NAMESPACE LOCAL`.
        line: where it begins.
        children: the elements in it.
        text: the text in it, without that of its children.
    """

    __slots__ = ("attributes", "children", "line", "name", "text")

    def __init__(self, name: str, attributes: dict[str, str], line: int) -> None:
        self.name = name
        self.attributes = attributes
        self.line = line
        self.children: list[Element] = []
        self.text = ""

    def get(self, name: str) -> str:
        """Return an attribute, empty where it is missing."""
        return self.attributes.get(name, "")

    def named(self, *names: str) -> Iterator[Element]:
        """Yield the children of these names, in their order."""
        return (child for child in self.children if child.name in names)

    def first(self, name: str) -> Element | None:
        """Return the first child of a name."""
        return next(self.named(name), None)

    def below(self) -> Iterator[Element]:
        """Yield the element and all that stand in it, in the order in which they begin."""
        pending = [self]
        while pending:
            element = pending.pop()
            yield element
            pending += reversed(element.children)


def document(source: Source) -> Element:
    """Return the root of a file's elements; names lose their namespaces.

    Raises:
        MeshError: as `XmlStream.run`.
    """
    stream = XmlStream(source)
    top = Element("", {}, 1)
    path, letters = [top], [[""]]

    def start(name: str, attributes: dict[str, str]) -> None:
        element = Element(name.rpartition(" ")[2], attributes, stream.line)
        path[-1].children.append(element)
        path.append(element)
        letters.append([])

    def end(_: str) -> None:
        path.pop().text = "".join(letters.pop())

    stream.parser.CharacterDataHandler = lambda text: letters[-1].append(text)
    stream.run([source.data], start, end)
    return top.children[0]
