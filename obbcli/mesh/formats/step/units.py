"""The unit of length that a STEP file states, as Open CASCADE understands it."""

from __future__ import annotations

from math import ldexp, log2
from typing import TYPE_CHECKING, Any, NamedTuple

from OCP.STEPConstruct import STEPConstruct_UnitContext
from OCP.StepData import StepData_Factors

from obbcli.mesh.units import UNITS

if TYPE_CHECKING:
    from collections.abc import Iterable

#: Conversions such as 2.54 times a centimetre are products of doubles.
_CLOSE = 1e-12
#: Units of fewer mm are none.
_LEAST = 1e-30


class Length(NamedTuple):
    """The length of 1 in a file.

    Attributes:
        millimetres: how many it is long, as the library computes it from the file.
        unit: our name of it; None where it has none, or where the file states no unit.
        notes: what is taken with a change.
    """

    millimetres: float
    unit: str | None
    notes: tuple[str, ...] = ()

    @property
    def exponent(self) -> int:
        """The power of two that the library's coordinates are times those of the file.

        The library's tolerances are made for mm. By a power of two lengths are brought near to
        them, and back, without being rounded.
        """
        return round(log2(self.millimetres))

    @property
    def asked(self) -> float:
        """How many mm the library's own unit is to be long."""
        return ldexp(self.millimetres, -self.exponent)


def length_of(entities: Iterable[Any]) -> Length:
    """Return the unit of the first context of the file that states one.

    Representations in another unit are scaled to it by the library, which a note tells.
    """
    found = list(dict.fromkeys(filter(None, map(_millimetres, entities))))
    if not found:
        return Length(1.0, None)
    names = [_name(length) for length in found]
    first = names[0]
    if first is None:
        note = f"states a unit of {found[0]:.9g} mm: its coordinates are turned into mm"
        return Length(1.0, "mm", (note,))
    others = [
        name or f"{length:.9g} mm"
        for name, length in zip(names, found, strict=True)
        if name != first
    ]
    if others:
        listed = ", ".join(dict.fromkeys(others))
        return Length(found[0], first, (f"coordinates in {listed} are turned into {first}",))
    return Length(found[0], first)


def _millimetres(entity: Any) -> float | None:
    """Return how long the unit of a context is; None where the entity is no context with one."""
    assigned = getattr(entity, "GlobalUnitAssignedContext", None)
    if assigned is None:
        return None
    factors = STEPConstruct_UnitContext()
    context = assigned()
    if context is None:
        return None
    factors.ComputeFactors(context, StepData_Factors())
    length = float(factors.LengthFactor())
    return length if factors.LengthDone() and _LEAST < length < 1.0 / _LEAST else None


def _name(millimetres: float) -> str | None:
    """Return the unit that is so long."""
    for name, micrometres in UNITS.items():
        if abs(millimetres * 1000.0 / micrometres - 1.0) < _CLOSE:
            return name
    return None
