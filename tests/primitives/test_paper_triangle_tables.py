"""Tables 5 to 7 of the paper, of two triangles, against the triangles themselves."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
import pytest
from oracles import paper_tables as paper

CLOSE = 1e-9
RUNS = 40


def triangles(rng: Any, *, coplanar: bool = False) -> dict[str, Any]:
    """Return what Tables 5 to 7 speak of."""
    a, b = rng.normal(size=(2, 3, 3))
    if coplanar:
        turn = paper.frame(rng)
        a, b = (np.column_stack((t[:, :2], np.ones(3))) @ turn for t in (a, b))
    return pair_quantities(a, b)


def pair_quantities(a: Any, b: Any) -> dict[str, Any]:
    e, f = paper.edges(a), paper.edges(b)
    n, m = np.cross(e[0], e[1]), np.cross(f[0], f[1])
    return (
        paper.FUNCTIONS
        | paper.vectors("E", e)
        | paper.vectors("F", f)
        | {"N": n, "M": m, "D": b[0] - a[0], "a": a, "b": b, "l2": n @ n, "mu": m @ n / (n @ n)}
        | {f"l{i}{j}": np.cross(e[i], f[j]) @ n / (n @ n) for i in (0, 1) for j in (0, 1)}
    )


@pytest.mark.parametrize(
    ("name", "row", "coplanar"),
    [
        *((name, row, False) for name, row in paper.TABLE_5.items()),
        *((name, row, True) for name, row in paper.TABLE_6.items()),
    ],
)
def test_tables_5_and_6_are_the_vertices_projections(name: str, row: Any, coplanar: bool) -> None:
    rng = np.random.default_rng(8)
    for _ in range(RUNS):
        q = triangles(rng, coplanar=coplanar)
        axis = paper.axis(name, q)

        places = np.concatenate((q["a"], q["b"])) @ axis - q["a"][0] @ axis

        q["q0"] = paper.evaluate(row[3], q)
        assert [paper.evaluate(entry, q) for entry in row] == pytest.approx(places, abs=CLOSE)


@pytest.mark.parametrize("case", ["greatest is zero", "least is zero"])
@pytest.mark.parametrize(("i", "j"), list(product(range(3), range(3))))
def test_table_7_edge_rows_give_the_point_on_the_first_triangle(i: int, j: int, case: str) -> None:
    rng = np.random.default_rng(9)
    for _ in range(RUNS):
        q = triangles(rng)
        axis = np.cross(q[f"E{i}"], q[f"F{j}"])
        p = (q["a"] - q["a"][0]) @ axis
        far = p[np.argmax(np.abs(p))]
        sigma = -np.sign(far) if case == "greatest is zero" else np.sign(far)
        x = point_of_first(i, case, rng.uniform())
        s = rng.uniform()
        y0, y1 = ((s, 0.0), (0.0, s), (1 - s, s))[j]
        shift = x[0] * q["E0"] + x[1] * q["E1"] - (q["D"] + y0 * q["F0"] + y1 * q["F1"])
        q = pair_quantities(q["a"], q["b"] + shift)

        row = paper.TABLE_7[i][0 if case == "greatest is zero" else 1]
        found = [paper.evaluate(entry, q) for entry in row]

        # The row's condition holds, and its point is the one that touches.
        extreme = (sigma * p).max() if case == "greatest is zero" else (sigma * p).min()
        assert extreme == pytest.approx(0.0)
        assert found == pytest.approx(list(x), abs=1e-6)


def point_of_first(i: int, case: str, s: float) -> tuple[float, float]:
    """Return (x_0, x_1) of Table 7: on edge i, or at the vertex opposite to it."""
    if case == "greatest is zero":
        return ((s, 0.0), (0.0, s), (0.0, 0.0))[i]
    return ((0.0, 1.0), (1.0, 0.0), (s, 1 - s))[i]


@pytest.mark.parametrize("sigma", [1, -1])
def test_table_7_face_rows_take_the_vertex_that_reaches_the_other_plane(sigma: int) -> None:
    """Row N: least sigma q_k. Row M: greatest sigma p_k (erratum 32)."""
    rng = np.random.default_rng(10)
    for _ in range(RUNS):
        q = triangles(rng)
        values_b, values_a = sigma * q["b"] @ q["N"], sigma * q["a"] @ q["M"]
        first, last = np.argmin(values_b), np.argmax(values_a)

        # Brought into contact there, B is beyond A's plane, and A behind B's.
        b = q["b"] + (q["a"].mean(axis=0) - q["b"][first])
        a = q["a"] + (q["b"].mean(axis=0) - q["a"][last])

        assert (sigma * (b - q["a"][0]) @ q["N"]).min() >= -CLOSE
        assert (sigma * (a - q["b"][0]) @ q["M"]).max() <= CLOSE
