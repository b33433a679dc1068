"""`Solids`: what closed solids are to each other whose surfaces meet, or one of which holds a part.

Depths decide, as far as they are needed: bodies touch where the thickness and both protrusions are
at most the band's overlap. The thickness alone does not do, as a bar through a thin wall is no
thicker than the wall; nor do the protrusions, which are none for two solids that are the same.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from obbcli.questions.containment import body_name
from obbcli.questions.overlap.alike import are_alike, lies_in
from obbcli.questions.overlap.depths import Depths
from obbcli.questions.overlap.same import are_equal
from obbcli.questions.overlap.volumes import SharedSpace

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.answers.overlap import Band, Depth, DepthWord, RelationWord
    from obbcli.answers.status import Inner
    from obbcli.questions.overlap.asked import Asked
    from obbcli.questions.overlap.pursuit import Pursuit
    from obbcli.questions.pair_question import PairQuestion

# Of a depth: what is doubled may lie on the far side of the surface that limits the depth.
_REACH = 2.0
_UNRESOLVED = {"relation": "unresolved", "contained": None}
# The thickness first: it mostly says yes, and a body that is thick is not touched.
DEPTHS: tuple[DepthWord, ...] = ("thickness", "protrusion_a", "protrusion_b")


class Solids:
    """Two closed solids that are not apart.

    Args:
        pair: A and B.
        asked: what is asked about them.
        band: what counts as touching.
        pursuit: the budget.
        apart: where the surfaces do not meet: which solid lies in the other, None where each has
            parts outside. No entry where they meet.
    """

    def __init__(
        self,
        pair: PairQuestion,
        asked: Asked,
        band: Band,
        pursuit: Pursuit,
        *apart: Inner | None,
    ) -> None:
        self._pair = pair
        self._asked = asked
        self._limit = band.overlap
        self._pursuit = pursuit
        self._apart = apart
        self.depths = Depths(pair, asked.tolerance, band.slack, pursuit)

    def related(self) -> dict[str, Any]:
        """Return the relation and the depths, by the names of `Overlap`."""
        asked = self._asked
        is_same = not self._apart and are_equal(self._pair)
        if is_same:
            self.depths.is_none("protrusion_a")
            self.depths.is_none("protrusion_b")
        found: dict[str, Any] = {}
        if asked.deeper_than is not None:
            found["deeper"], found["by"] = self._deeper(asked.deeper_than)
        relation, inner = ("duplicate", None) if is_same else self._relation()
        if self._has_values(relation):
            for name in DEPTHS:
                self.depths.settle(name)
        found |= {"relation": relation, "contained": inner}
        found |= {name: self.depths.told(name) for name in DEPTHS}
        return self._with_space(found)

    def _with_space(self, found: dict[str, Any]) -> dict[str, Any]:
        """Add the volume, and take back what solids that overlap themselves leave open."""
        has_values = self._has_values(found["relation"])
        if found["relation"] == "overlapping" and found.get("deeper", True) and not has_values:
            return found  # by lower ends alone
        space = SharedSpace(self._pair, self._pursuit)
        told = {name: found[name] for name in DEPTHS if found[name] is not None}
        reach = _REACH * max((depth.bounds[1] or 0.0 for depth in told.values()), default=0.0)
        doubled = space.doubled(reach)
        hidden = () if doubled == () else tuple(self._hidden(space, told))
        if has_values and self._asked.has_volume:
            found["volume"] = space.volume()
        if not hidden:
            return found
        return _by_lower_ends(found, hidden, self._limit, self._why_hidden(doubled))

    def _hidden(self, space: SharedSpace, told: dict[DepthWord, Depth]) -> Iterator[DepthWord]:
        """Yield the depths that a surface within one of the solids may limit.

        No ball inside both leaves the box that they have in common, so that the thickness is that
        of what lies there. A protrusion is the distance of a point of that box from the surface of
        the other solid, which no surface of the latter further away limits; but the point is to be
        one of the boundary of its own solid.
        """
        for name, depth in told.items():
            here = space.doubled(0.0)
            near = space.doubled(_REACH * (depth.bounds[1] or 0.0)) if name != "thickness" else here
            if here is None or near is None:
                yield name
            elif name == "thickness":
                if here:
                    yield name
            elif (name[-1] in here) or ("ab".replace(name[-1], "") in near):
                yield name

    def _why_hidden(self, doubled: tuple[Inner, ...] | None) -> str:
        """Return why depths are known from below alone."""
        if doubled is None:
            return "a limit was reached before it was known whether A or B overlaps itself"
        names = [body_name(one.upper(), self._pair.trees["ab".index(one)]) for one in doubled]
        verb = "overlaps itself" if len(names) == 1 else "overlap themselves"
        return f"{' and '.join(names)} {verb}, and surfaces within hide how deep it is"

    def _has_values(self, relation: RelationWord) -> bool:
        """Return whether depths are narrowed down, and not only as far as the relation needs it.

        Those within a default band are rounding, and their values cost most.
        """
        if self._asked.values == "all" and self._asked.touch is not None:
            return True
        return self._asked.values != "none" and relation != "touching"

    def _deeper(self, limit: float) -> tuple[bool | None, DepthWord | None]:
        """Return whether a depth exceeds a limit, and which was found to."""
        is_known = True
        for name in DEPTHS:
            exceeds = self.depths.exceeds(name, limit)
            if exceeds:
                return True, name
            is_known &= exceeds is not None
        return (False if is_known else None), None

    def _relation(self) -> tuple[RelationWord, Inner | None]:
        """Return the relation of solids that are not bit by bit the same, and which is inside."""
        is_deep, _ = self._deeper(self._limit)
        if is_deep is None:
            return "unresolved", None
        if self._apart:
            inner = self._apart[0]
            if not is_deep:
                return "touching", None
            return ("overlapping" if inner is None else "contained"), inner
        return self._of_meeting(is_deep=is_deep)

    def _of_meeting(self, *, is_deep: bool) -> tuple[RelationWord, Inner | None]:
        """Return the relation of solids whose surfaces meet."""
        into_a, into_b = (
            self.depths.exceeds(name, self._limit) for name in ("protrusion_b", "protrusion_a")
        )
        if into_a is None or into_b is None:
            return "unresolved", None
        if not (into_a or into_b):
            is_alike = are_alike(self._pair, self.depths, self._limit)
            if is_alike is None:
                return "unresolved", None
            if is_alike:
                return "duplicate", None
        if not is_deep:
            return "touching", None
        # Which surface does not reach into the other solid: that one may hold the other.
        sides: tuple[tuple[Inner, bool], ...] = (("a", into_a), ("b", into_b))
        for inner, is_entered in sides:
            lies = not is_entered and lies_in(self._pair, inner, self._limit, self._pursuit)
            if lies is None:
                return "unresolved", None
            if lies:
                return "contained", inner
        return "overlapping", None


def _by_lower_ends(
    found: dict[str, Any], hidden: tuple[DepthWord, ...], limit: float, reason: str
) -> dict[str, Any]:
    """Return what is proven where the upper ends of some depths are not known.

    Args:
        found: what was found with both ends.
        hidden: those that have no upper ends.
        limit: the overlap that still counts as touching, mesh units.
        reason: why.
    """
    ends = {name: replace(found[name], bounds=(found[name].bounds[0], None)) for name in hidden}
    depths = [depth for name in DEPTHS if (depth := found[name]) is not None]
    is_deep = any(depth.bounds[0] > limit for depth in depths)
    stands = found["relation"] == "duplicate" or (
        is_deep and found["relation"] in ("overlapping", "contained")
    )
    deeper = {"deeper": None} if found.get("deeper") is False else {}
    return found | ends | ({} if stands else _UNRESOLVED) | deeper | {"reason": reason}
