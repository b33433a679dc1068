"""What the keywords of an Abaqus deck define: parts, instances, and what is outside of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from obbcli.mesh.formats.abaqus import generated
from obbcli.mesh.formats.abaqus.cells import cells_of
from obbcli.mesh.formats.abaqus.keywords import NAMED_SURFACES, PASSED_OVER, REFUSED
from obbcli.mesh.formats.abaqus.scope import Scope
from obbcli.mesh.formats.abaqus.sections import check_options
from obbcli.mesh.formats.abaqus.systems import local_system, placement
from obbcli.mesh.formats.text import counted

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from obbcli.errors import MeshError
    from obbcli.mesh.formats.abaqus.sections import Deck, Section
    from obbcli.mesh.formats.abaqus.systems import Placement
    from obbcli.mesh.formats.cells.parts import CellPart
    from obbcli.mesh.source import Source


class Body(NamedTuple):
    """Holds one surface of a deck: an instance, a part where none is placed, or what is in neither.

    Args:
        name: of the instance or part; "" for what is in neither.
        scopes: what define it, in order.
        matrix: (4, 4), applied to columns, from its nodes to where it stands; None: the identity.
    """

    name: str
    scopes: tuple[Scope, ...]
    matrix: NDArray[np.float64] | None = None

    @property
    def key(self) -> tuple[int, ...]:
        """Return what is equal for copies: instances of one part that define nothing themselves."""
        return tuple(id(scope) for scope in self.scopes if not scope.is_empty)

    def cells(self, source: Source) -> CellPart:
        """Return its cells, in its own coordinates.

        Raises:
            MeshError: what it defines is not read, or damaged; with the line.
        """
        scopes = [scope for scope in self.scopes if not scope.is_empty]
        for scope in scopes:
            scope.read()
        return cells_of(source, scopes)._replace(name=self.name)


class _Instance(NamedTuple):
    """Holds an instance: the part's name, where it stands, and what it defines itself."""

    scope: Scope
    part: str
    place: Placement
    section: Section


class Model:
    """Holds what the keywords so far have defined."""

    def __init__(self) -> None:
        # Of a flat deck, or of the assembly.
        self._outer = Scope()
        self._scope = self._outer
        self._parts: dict[str, Scope] = {}
        self._instances: list[_Instance] = []
        self._is_in_step = False
        self._notes: dict[str, None] = {}

    @property
    def element_count(self) -> int:
        """Return how many elements all parts define.

        Raises:
            MeshError: what a part defines is not read, or damaged.
        """
        scopes = [self._outer, *self._parts.values(), *(each.scope for each in self._instances)]
        for scope in scopes:
            scope.read()
        return sum(len(block.numbers) for scope in scopes for block in scope.elements)

    def take(self, deck: Deck, section: Section) -> None:
        """Take one keyword.

        Raises:
            MeshError: it is not read; with the line.
        """
        keyword = section.keyword
        reader = _READERS.get(keyword)
        if keyword in _WITH_INPUT:
            section = deck.input_of(section)
        if reader is not None:
            self._scope.keep(reader, section)
        elif keyword in _STRUCTURE:
            _STRUCTURE[keyword](self, section)
        elif keyword in REFUSED:
            what, remedy = REFUSED[keyword]
            raise _refused(section, f"*{keyword} {what}, which is not read", remedy)
        elif keyword in PASSED_OVER:
            self._pass_over(section)
        elif not self._is_in_step and not _abbreviates(keyword):
            remedy = "write its name in full; remove it if it makes and moves no part of the mesh"
            raise _refused(section, f"the keyword *{keyword[:40]} is not known", remedy)

    def _pass_over(self, section: Section) -> None:
        """Note keywords after which the analysis has another shape than the deck."""
        keyword, adjust = section.keyword, section.label("ADJUST")
        is_tie = keyword == "TIE" and adjust != "NO"
        if is_tie or keyword == "ADJUST" or (keyword == "CONTACTPAIR" and adjust):
            name = {"CONTACTPAIR": "CONTACT PAIR"}.get(keyword, keyword)
            note = f"*{name} may move nodes when the analysis begins: taken where the deck has them"
            self._notes[note] = None
        elif keyword == "CYCLICSYMMETRYMODEL":
            self._notes["*CYCLIC SYMMETRY MODEL: taken as the one sector that is written"] = None
        elif keyword == "MODELCHANGE" and "REMOVE" in section.options:
            self._notes["elements that *MODEL CHANGE removes in a step are taken"] = None

    def set_step(self, section: Section) -> None:
        """Note whether what follows is the history of an analysis, which defines no mesh."""
        self._is_in_step = section.keyword == "STEP"

    def begin_part(self, section: Section) -> None:
        """Take *PART."""
        check_options(section, {"NAME", "INTERNAL"})
        name = section.label("NAME")
        if self._scope is not self._outer or name in self._parts:
            fault = f"*PART '{name[:40]}' begins in another part, or a second time"
            raise _refused(section, fault, "end each part with *END PART")
        self._scope = self._parts[name] = Scope(section.options.get("NAME", ""))

    def begin_instance(self, section: Section) -> None:
        """Take *INSTANCE."""
        check_options(section, {"NAME", "PART"})
        if self._scope is not self._outer or section.label("PART") not in self._parts:
            fault = f"*INSTANCE of '{section.label('PART')[:40]}', which is no part so far"
            raise _refused(section, fault, "define the part before the assembly")
        self._scope = Scope(section.options.get("NAME", ""))
        place = placement(section)
        self._instances.append(_Instance(self._scope, section.label("PART"), place, section))

    def end_scope(self, section: Section) -> None:
        """Take *END PART or *END INSTANCE."""
        if self._scope is self._outer:
            raise _refused(section, f"*{section.keyword} ends what did not begin", "remove it")
        self._scope = self._outer

    def surface_by_name(self, section: Section) -> None:
        """Take *SURFACE: a name for faces of elements, or a surface by formula."""
        kind = "".join(section.label("TYPE").split())
        if kind not in NAMED_SURFACES:
            what = f"*SURFACE of type {kind[:20]} makes a surface by a formula, which is not read"
            raise _refused(section, what, "mesh it with elements such as R3D4, or remove it")

    def bodies(self, source: Source) -> list[Body]:
        """Return what stands in the file: instances, else parts, and what is outside of them.

        By their keywords alone, what has no surface is left out.

        Raises:
            MeshError: the deck ends within a part.
        """
        if self._scope is not self._outer:
            fault = f"ends within the part or instance '{self._scope.name[:40]}'"
            raise source.error(fault, "it was cut short: write it again")
        for note in self._notes:
            source.note(note)
        used = {instance.part for instance in self._instances}
        left = [scope for name, scope in self._parts.items() if name not in used]
        left = [scope for scope in left if scope.has_surface]
        found = [
            Body(each.scope.name, (self._parts[each.part], each.scope), each.place.matrix)
            for each in self._instances
        ]
        if used and left:
            names = ", ".join(f"'{scope.name}'" for scope in left[:5])
            source.note(f"{counted(len(left), 'part')} without an instance left out: {names}")
        elif left:
            source.note(
                f"{counted(len(left), 'part')} taken where written: no *INSTANCE places any"
            )
            found += [Body(scope.name, (scope,)) for scope in left]
        found.append(Body("", (self._outer,)))
        return [body for body in found if any(scope.has_surface for scope in body.scopes)]


def _abbreviates(keyword: str) -> bool:
    """Return whether a keyword begins one that is passed over, and none that is read or refused.

    Keywords need not be written out as long as they can be told apart.
    """
    known = {*_READERS, *_STRUCTURE, *REFUSED, "INCLUDE"}
    if any(name.startswith(keyword) for name in known):
        return False
    return any(name.startswith(keyword) for name in PASSED_OVER)


def _refused(section: Section, fault: str, remedy: str) -> MeshError:
    return section.source.error(fault, remedy, at=str(section.line))


def _set_system(scope: Scope, section: Section) -> None:
    scope.system = local_system(section)


def _add_set(scope: Scope, section: Section) -> None:
    """Keep a set for the keywords that generate; others need none."""
    sets = scope.sets if section.keyword == "NSET" else scope.element_sets
    sets.setdefault(section.label(section.keyword), []).append(section)


#: What defines nodes and elements, in the part or instance it stands in.
_READERS: dict[str, Callable[[Scope, Section], None]] = {
    "NODE": Scope.read_nodes,
    "ELEMENT": Scope.read_elements,
    "NSET": _add_set,
    "ELSET": _add_set,
    "SYSTEM": _set_system,
    "NGEN": generated.generate_nodes,
    "NFILL": generated.fill_nodes,
    "NCOPY": generated.copy_nodes,
    "ELGEN": generated.generate_elements,
    "ELCOPY": generated.copy_elements,
}
#: What divides the deck.
_STRUCTURE: dict[str, Callable[[Model, Section], None]] = {
    "PART": Model.begin_part,
    "ENDPART": Model.end_scope,
    "ASSEMBLY": lambda _model, section: check_options(section, {"NAME"}),
    "ENDASSEMBLY": lambda _model, section: check_options(section, set()),
    "INSTANCE": Model.begin_instance,
    "ENDINSTANCE": Model.end_scope,
    "STEP": Model.set_step,
    "ENDSTEP": Model.set_step,
    "SURFACE": Model.surface_by_name,
}
#: Those whose data INPUT may name a file for.
_WITH_INPUT = frozenset(("NODE", "ELEMENT"))
