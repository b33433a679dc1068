"""The second opinion on `still` and `moving`: exact linear programming, no axes anywhere.

Hulls P and Q, Q moving with W relative to P, meet at t where convex weights give
`sum u_i p_i == sum v_j q_j + t W`; the least and the greatest such t come from the simplex method.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from oracles.exact import Hull, relative_velocity, same_unit

if TYPE_CHECKING:
    from collections.abc import Sequence

Row = list[int]


def hulls_intersect_lp(p: Hull, q: Hull) -> bool:
    """Return whether two hulls share a point."""
    still = (0, 0, 0)
    return contact_interval_lp(p, q, still, still, 0) is not None


def contact_interval_lp(
    p: Hull, q: Hull, velocity_p: Sequence[float], velocity_q: Sequence[float], duration: float
) -> tuple[Fraction, Fraction] | None:
    """Return the first and the last time of contact in [0, duration], or None."""
    p, q = same_unit(p, q)
    velocity, velocity_unit = relative_velocity(velocity_p, velocity_q)
    # Time in units of `clock` keeps every coefficient an integer.
    clock = p.unit / velocity_unit
    horizon = Fraction(duration) / clock
    count_p, count_q = len(p.points), len(q.points)
    rows: list[Row] = [
        [x[i] for x in p.points] + [-x[i] for x in q.points] + [-velocity[i], 0, 0]
        for i in range(3)
    ]
    rows.append([1] * count_p + [0] * count_q + [0, 0, 1])
    rows.append([0] * count_p + [1] * count_q + [0, 0, 1])
    time = count_p + count_q
    rows.append([0] * time + [horizon.denominator, horizon.denominator, horizon.numerator])
    tableau = _Tableau(rows, [[int(i == time) for i in range(time + 2)]])
    if not tableau.find_corner():
        return None
    first = tableau.minimize()
    tableau.negate_cost()
    last = -tableau.minimize()
    return first * clock, last * clock


class _Tableau:
    """A simplex tableau in integers: every entry is over one common denominator, the last pivot.

    Division after a pivot is exact (Edmonds 1967); Bland's rule forbids cycling.
    """

    def __init__(self, rows: list[Row], costs: list[Row]) -> None:
        self.width = len(rows[0]) - 1
        self.denominator = 1
        self.rows = rows
        # Artificial variables have no columns: once out of the basis they never return.
        self.basis = [self.width + i for i in range(len(rows))]
        self.cost = [*costs[0], 0]
        self.phase_one = [-sum(column) for column in zip(*rows, strict=True)]

    def find_corner(self) -> bool:
        """Return whether any solution exists, and move to one."""
        while (column := self._entering(self.phase_one)) is not None:
            self._pivot(self._leaving(column), column)
        if self.phase_one[-1]:
            return False
        for i in range(len(self.rows) - 1, -1, -1):
            if self.basis[i] >= self.width:
                self._drive_out(i)
        return True

    def minimize(self) -> Fraction:
        """Return the least cost; the problem must be bounded."""
        while (column := self._entering(self.cost)) is not None:
            self._pivot(self._leaving(column), column)
        return Fraction(-self.cost[-1], self.denominator)

    def negate_cost(self) -> None:
        self.cost = [-x for x in self.cost]

    def _entering(self, cost: Row) -> int | None:
        return next((j for j in range(self.width) if cost[j] < 0), None)

    def _leaving(self, column: int) -> int:
        best = -1
        for i, row in enumerate(self.rows):
            if row[column] <= 0:
                continue
            if best < 0:
                best = i
                continue
            ahead = row[-1] * self.rows[best][column] - self.rows[best][-1] * row[column]
            if ahead < 0 or (ahead == 0 and self.basis[i] < self.basis[best]):
                best = i
        assert best >= 0, "weights and times are bounded"
        return best

    def _drive_out(self, i: int) -> None:
        """Replace an artificial variable at level zero, or drop its redundant row."""
        column = next((j for j in range(self.width) if self.rows[i][j]), None)
        if column is None:
            del self.rows[i], self.basis[i]
            return
        if self.rows[i][column] < 0:
            self.rows[i] = [-x for x in self.rows[i]]
        self._pivot(i, column)

    def _pivot(self, i: int, j: int) -> None:
        pivot_row = self.rows[i]
        pivot = pivot_row[j]
        for k, row in enumerate(self.rows):
            if k != i:
                self.rows[k] = self._eliminated(row, pivot_row, pivot, j)
        self.cost = self._eliminated(self.cost, pivot_row, pivot, j)
        self.phase_one = self._eliminated(self.phase_one, pivot_row, pivot, j)
        self.denominator = pivot
        self.basis[i] = j

    def _eliminated(self, row: Row, pivot_row: Row, pivot: int, j: int) -> Row:
        factor = row[j]
        return [
            (x * pivot - factor * y) // self.denominator
            for x, y in zip(row, pivot_row, strict=True)
        ]
