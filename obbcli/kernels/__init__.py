"""The compiled kernels; the only module that touches the extension.

Everything with a tight loop lives behind this border. Arrays that cross it were checked by
`obbcli.arrays`, and every call that can take longer than a millisecond releases the GIL.
"""

from __future__ import annotations

import copyreg
from dataclasses import fields
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar, cast

from obbcli.kernels._core import (
    AtRestAnswer,
    ClearanceQuery,
    ColumnVolume,
    Contact,
    ContactPlace,
    ContactQuery,
    ContainmentQuery,
    DistanceQuery,
    Evidence,
    FileTree,
    Fit,
    Limits,
    OverlapRegions,
    Placed,
    PlacedBody,
    Pose,
    ProtrusionQuery,
    QuickCall,
    Screw,
    SelfOverlap,
    SolidProbe,
    Split,
    StaticQuery,
    ThicknessQuery,
    Tree,
    TreeBuilder,
    TreeError,
    ask_pairs,
    block_checksums,
    collide,
    convex_hull,
    crc32,
    crc32_by_tables,
    first_triangles_of_parts,
    keeps_denormals,
    primitive_first_contacts,
    primitive_intersects,
    roots_are_apart,
    set_answer_classes,
    set_body_defaults,
    solve_matrix_game,
    sweep,
    sweep_columns,
    swept_pairs,
    triangle_pairs,
)

if not keeps_denormals():
    raise ImportError(
        "this process flushes denormal numbers to zero (a library linked with -ffast-math was "
        "loaded before), which would void the proofs of obbtree; import obbcli first, or remove it"
    )

if TYPE_CHECKING:
    from collections.abc import Callable

_Class = TypeVar("_Class", bound=type)
_Function = TypeVar("_Function", bound="Callable[..., Any]")


def made_by_kernels(cls: _Class) -> _Class:
    """Let objects of a frozen dataclass be made by the type of the kernels that it derives from.

    That type makes what it can from the arguments of a call; for all others it calls `__init__` as
    the class has it, under the name `_checked`. It holds fields under their names with an
    underscore before, takes them over by `_hold`, and is pickled and copied by its fields.
    """
    made: Any = cls
    base = made.__mro__[1]
    if "__init__" in vars(base):
        made._checked = made.__init__
        del made.__init__
    names = [field.name for field in fields(made) if hasattr(base, f"_{field.name}")]
    for name in names:
        # Only now: a dataclass would take it for the field's default.
        setattr(made, name, getattr(base, f"_{name}"))
    for name, value in vars(base).items():
        if not name.startswith("_"):
            setattr(made, name, value)  # so that the class documents it as its own

    def reduced(self: Any) -> tuple[object, ...]:
        state = {field.name: getattr(self, field.name) for field in fields(self)}
        return copyreg.__newobj__, (type(self),), vars(self) | state  # type: ignore[attr-defined]

    def set_state(self: Any, state: dict[str, object]) -> None:
        rest = dict(state)
        self._hold(*(rest.pop(name) for name in names))
        vars(self).update(rest)

    made.__reduce__, made.__setstate__ = reduced, set_state
    return cls


class QuickQuestion(NamedTuple):
    """What a function asks that is called with two bodies and nothing else.

    Attributes:
        limits: how far it is pursued.
        duration: s, where a body moves.
        time_tolerance: s.
        any_contact: whether any proof of contact will do, not of the first.
        screw_of: returns how a body moves, given the body and its tree.
        going_on: answers a question about moving bodies that the kernels began and did not find
            apart, nor in contact at t = 0 where any contact will do, given the bodies and the
            kernels' queries: about t = 0, about the motion or None, and whether all is answered.
        told: returns the answer, given the bodies and what was found, an `AtRestAnswer`, of bodies
            at rest or apart. None: what was found is the answer.
        named: names the parts in an answer about trees that have some, given the bodies and what
            was found. Needed where that is the answer.
    """

    limits: Limits
    duration: float
    time_tolerance: float
    any_contact: bool
    screw_of: Callable[..., Screw]
    going_on: Callable[..., object]
    told: Callable[..., object] | None = None
    named: Callable[..., object] | None = None


def asked_by_kernels_first(question: QuickQuestion) -> Callable[[_Function], _Function]:
    """Let a call with two bodies, and nothing else, be answered by the kernels.

    That is so where bodies that have their trees rest or have constant velocities. Every other call
    goes to the function, as do those that the kernels refuse. What is made looks like the function:
    its name, documentation, signature and pickle are those of the function.
    """
    from functools import update_wrapper

    def quick(function: _Function) -> _Function:
        return cast("_Function", update_wrapper(QuickCall(function, *question), function))

    return quick


__all__ = [
    "AtRestAnswer",
    "ClearanceQuery",
    "ColumnVolume",
    "Contact",
    "ContactPlace",
    "ContactQuery",
    "ContainmentQuery",
    "DistanceQuery",
    "Evidence",
    "FileTree",
    "Fit",
    "Limits",
    "OverlapRegions",
    "Placed",
    "PlacedBody",
    "Pose",
    "ProtrusionQuery",
    "QuickCall",
    "QuickQuestion",
    "Screw",
    "SelfOverlap",
    "SolidProbe",
    "Split",
    "StaticQuery",
    "ThicknessQuery",
    "Tree",
    "TreeBuilder",
    "TreeError",
    "ask_pairs",
    "asked_by_kernels_first",
    "block_checksums",
    "collide",
    "convex_hull",
    "crc32",
    "crc32_by_tables",
    "first_triangles_of_parts",
    "made_by_kernels",
    "primitive_first_contacts",
    "primitive_intersects",
    "roots_are_apart",
    "set_answer_classes",
    "set_body_defaults",
    "solve_matrix_game",
    "sweep",
    "sweep_columns",
    "swept_pairs",
    "triangle_pairs",
]
