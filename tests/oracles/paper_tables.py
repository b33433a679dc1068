"""The tables of Eberly 2008, row by row, in the paper's letters; corrected entries say so.

Each entry is a Python expression over the paper's quantities: `@` is the dot product, `x(u, v)` the
cross product, `sgn` the sign and `sg` its sigma. Numbers in comments are those of the errata on
the page of `obbcli.primitives`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

# Table 1: L, R_0, R_1, R of two boxes. The last row is A_2 x B_2, printed A_2 x B_1 (6).
TABLE_1 = {
    "A0": ("a0", "b0*abs(c00)+b1*abs(c01)+b2*abs(c02)", "abs(A0@D)"),
    "A1": ("a1", "b0*abs(c10)+b1*abs(c11)+b2*abs(c12)", "abs(A1@D)"),
    "A2": ("a2", "b0*abs(c20)+b1*abs(c21)+b2*abs(c22)", "abs(A2@D)"),
    "B0": ("a0*abs(c00)+a1*abs(c10)+a2*abs(c20)", "b0", "abs(B0@D)"),
    "B1": ("a0*abs(c01)+a1*abs(c11)+a2*abs(c21)", "b1", "abs(B1@D)"),
    "B2": ("a0*abs(c02)+a1*abs(c12)+a2*abs(c22)", "b2", "abs(B2@D)"),
    "A0 B0": ("a1*abs(c20)+a2*abs(c10)", "b1*abs(c02)+b2*abs(c01)", "abs(c10*A2@D-c20*A1@D)"),
    "A0 B1": ("a1*abs(c21)+a2*abs(c11)", "b0*abs(c02)+b2*abs(c00)", "abs(c11*A2@D-c21*A1@D)"),
    "A0 B2": ("a1*abs(c22)+a2*abs(c12)", "b0*abs(c01)+b1*abs(c00)", "abs(c12*A2@D-c22*A1@D)"),
    "A1 B0": ("a0*abs(c20)+a2*abs(c00)", "b1*abs(c12)+b2*abs(c11)", "abs(c20*A0@D-c00*A2@D)"),
    "A1 B1": ("a0*abs(c21)+a2*abs(c01)", "b0*abs(c12)+b2*abs(c10)", "abs(c21*A0@D-c01*A2@D)"),
    "A1 B2": ("a0*abs(c22)+a2*abs(c02)", "b0*abs(c11)+b1*abs(c10)", "abs(c22*A0@D-c02*A2@D)"),
    "A2 B0": ("a0*abs(c10)+a1*abs(c00)", "b1*abs(c22)+b2*abs(c21)", "abs(c00*A1@D-c10*A0@D)"),
    "A2 B1": ("a0*abs(c11)+a1*abs(c01)", "b0*abs(c22)+b2*abs(c20)", "abs(c01*A1@D-c11*A0@D)"),
    "A2 B2": ("a0*abs(c12)+a1*abs(c02)", "b0*abs(c21)+b1*abs(c20)", "abs(c02*A1@D-c12*A0@D)"),
}

# Table 1': axes of moving boxes; al and be are alpha and beta.
TABLE_1_PRIME = {
    "W A0": (
        "a1*abs(al2)+a2*abs(al1)",
        "sum(b[i]*abs(c[1,i]*al2-c[2,i]*al1) for i in (0,1,2))",
        "abs(A0@x(W,D))",
    ),
    "W A1": (
        "a0*abs(al2)+a2*abs(al0)",
        "sum(b[i]*abs(c[0,i]*al2-c[2,i]*al0) for i in (0,1,2))",
        "abs(A1@x(W,D))",
    ),
    "W A2": (
        "a0*abs(al1)+a1*abs(al0)",
        "sum(b[i]*abs(c[0,i]*al1-c[1,i]*al0) for i in (0,1,2))",
        "abs(A2@x(W,D))",
    ),
    "W B0": (
        "sum(a[i]*abs(c[i,1]*be2-c[i,2]*be1) for i in (0,1,2))",
        "b1*abs(be2)+b2*abs(be1)",
        "abs(B0@x(W,D))",
    ),
    "W B1": (
        "sum(a[i]*abs(c[i,0]*be2-c[i,2]*be0) for i in (0,1,2))",
        "b0*abs(be2)+b2*abs(be0)",
        "abs(B1@x(W,D))",
    ),
    "W B2": (
        "sum(a[i]*abs(c[i,0]*be1-c[i,1]*be0) for i in (0,1,2))",
        "b0*abs(be1)+b1*abs(be0)",
        "abs(B2@x(W,D))",
    ),
}

# Table 2, rows A_i x B_j: signs of the fixed coordinates and the c_ij they come from.
# Row A_i: y_j = -sg Sign(c_ij) b_j. Row B_i: x_j = sg Sign(c_ji) a_j, printed with c_ij (16).
TABLE_2 = {
    "A0 B0": {
        "x1": "-sg*sgn(c20)*a1",
        "x2": "sg*sgn(c10)*a2",
        "y1": "-sg*sgn(c02)*b1",
        "y2": "sg*sgn(c01)*b2",
    },
    "A0 B1": {
        "x1": "-sg*sgn(c21)*a1",
        "x2": "sg*sgn(c11)*a2",
        "y0": "sg*sgn(c02)*b0",
        "y2": "-sg*sgn(c00)*b2",
    },
    "A0 B2": {
        "x1": "-sg*sgn(c22)*a1",
        "x2": "sg*sgn(c12)*a2",
        "y0": "-sg*sgn(c01)*b0",
        "y1": "sg*sgn(c00)*b1",
    },
    "A1 B0": {
        "x0": "sg*sgn(c20)*a0",
        "x2": "-sg*sgn(c00)*a2",
        "y1": "-sg*sgn(c12)*b1",
        "y2": "sg*sgn(c11)*b2",
    },
    "A1 B1": {
        "x0": "sg*sgn(c21)*a0",
        "x2": "-sg*sgn(c01)*a2",
        "y0": "sg*sgn(c12)*b0",
        "y2": "-sg*sgn(c10)*b2",
    },
    "A1 B2": {
        "x0": "sg*sgn(c22)*a0",
        "x2": "-sg*sgn(c02)*a2",
        "y0": "-sg*sgn(c11)*b0",
        "y1": "sg*sgn(c10)*b1",
    },
    "A2 B0": {
        "x0": "-sg*sgn(c10)*a0",
        "x1": "sg*sgn(c00)*a1",
        "y1": "-sg*sgn(c22)*b1",
        "y2": "sg*sgn(c21)*b2",
    },
    "A2 B1": {
        "x0": "-sg*sgn(c11)*a0",
        "x1": "sg*sgn(c01)*a1",
        "y0": "sg*sgn(c22)*b0",
        "y2": "-sg*sgn(c20)*b2",
    },
    "A2 B2": {
        "x0": "-sg*sgn(c12)*a0",
        "x1": "sg*sgn(c02)*a1",
        "y0": "-sg*sgn(c21)*b0",
        "y1": "sg*sgn(c20)*b1",
    },
}
# Their last coordinate, x_i of A_i x B_j.
TABLE_2_LAST = {
    "A0 B0": "(A0@D+c00*(-B0@D+c10*x1+c20*x2)+c01*y1+c02*y2)/(1-c00**2)",
    "A0 B1": "(A0@D+c01*(-B1@D+c11*x1+c21*x2)+c00*y0+c02*y2)/(1-c01**2)",
    "A0 B2": "(A0@D+c02*(-B2@D+c12*x1+c22*x2)+c00*y0+c01*y1)/(1-c02**2)",
    "A1 B0": "(A1@D+c10*(-B0@D+c00*x0+c20*x2)+c11*y1+c12*y2)/(1-c10**2)",
    "A1 B1": "(A1@D+c11*(-B1@D+c01*x0+c21*x2)+c10*y0+c12*y2)/(1-c11**2)",
    "A1 B2": "(A1@D+c12*(-B2@D+c02*x0+c22*x2)+c10*y0+c11*y1)/(1-c12**2)",
    "A2 B0": "(A2@D+c20*(-B0@D+c00*x0+c10*x1)+c21*y1+c22*y2)/(1-c20**2)",
    "A2 B1": "(A2@D+c21*(-B1@D+c01*x0+c11*x1)+c20*y0+c22*y2)/(1-c21**2)",
    "A2 B2": "(A2@D+c22*(-B2@D+c02*x0+c12*x1)+c20*y0+c21*y1)/(1-c22**2)",
}

# Table 3: R, p_0, p_1, p_2 of a box and a triangle.
TABLE_3 = {
    "N": ("a0*abs(N@A0)+a1*abs(N@A1)+a2*abs(N@A2)", "N@D", "p0", "p0"),
    "A0": ("a0", "A0@D", "p0+A0@E0", "p0+A0@E1"),
    "A1": ("a1", "A1@D", "p0+A1@E0", "p0+A1@E1"),
    "A2": ("a2", "A2@D", "p0+A2@E0", "p0+A2@E1"),
    "A0 E0": ("a1*abs(A2@E0)+a2*abs(A1@E0)", "x(A0,E0)@D", "p0", "p0+A0@N"),
    "A0 E1": ("a1*abs(A2@E1)+a2*abs(A1@E1)", "x(A0,E1)@D", "p0-A0@N", "p0"),
    "A0 E2": ("a1*abs(A2@E2)+a2*abs(A1@E2)", "x(A0,E2)@D", "p0-A0@N", "p0-A0@N"),
    "A1 E0": ("a0*abs(A2@E0)+a2*abs(A0@E0)", "x(A1,E0)@D", "p0", "p0+A1@N"),
    "A1 E1": ("a0*abs(A2@E1)+a2*abs(A0@E1)", "x(A1,E1)@D", "p0-A1@N", "p0"),
    "A1 E2": ("a0*abs(A2@E2)+a2*abs(A0@E2)", "x(A1,E2)@D", "p0-A1@N", "p0-A1@N"),
    "A2 E0": ("a0*abs(A1@E0)+a1*abs(A0@E0)", "x(A2,E0)@D", "p0", "p0+A2@N"),
    "A2 E1": ("a0*abs(A1@E1)+a1*abs(A0@E1)", "x(A2,E1)@D", "p0-A2@N", "p0"),
    "A2 E2": ("a0*abs(A1@E2)+a1*abs(A0@E2)", "x(A2,E2)@D", "p0-A2@N", "p0-A2@N"),
}

# Tables 4b to 4d: fixed box coordinates of A_i x E_j, the same for each j.
TABLE_4_FIXED = {
    0: {"x1": "-sg*sgn(A2@E)*a1", "x2": "sg*sgn(A1@E)*a2"},
    1: {"x0": "sg*sgn(A2@E)*a0", "x2": "-sg*sgn(A0@E)*a2"},
    2: {"x0": "-sg*sgn(A1@E)*a0", "x1": "sg*sgn(A0@E)*a1"},
}
# The triangle's fixed coordinate where p_0 is extreme, and where the other p is; then x_i.
TABLE_4_TRIANGLE = {0: ("y1", 0, 1), 1: ("y0", 0, 1), 2: ("y0+y1", 0, 1)}
TABLE_4_LAST = {
    0: "(N@x(D,E0)-N@N*y-sum(N@x(A[k],E0)*X[k] for k in others))/(N@x(A[i],E0))",
    1: "(N@x(D,E1)+N@N*y-sum(N@x(A[k],E1)*X[k] for k in others))/(N@x(A[i],E1))",
    2: "(N@x(D,E2)+N@N*y-sum(N@x(A[k],E2)*X[k] for k in others))/(N@x(A[i],E2))",
}

# Table 5: p_0 to p_2 and q_0 to q_2 of two triangles.
TABLE_5 = {
    "N": ("0", "0", "0", "N@D", "q0+N@F0", "q0+N@F1"),
    "M": ("0", "M@E0", "M@E1", "M@D", "q0", "q0"),
    "E0 F0": ("0", "0", "-N@F0", "x(E0,F0)@D", "q0", "q0+M@E0"),
    "E0 F1": ("0", "0", "-N@F1", "x(E0,F1)@D", "q0-M@E0", "q0"),
    "E0 F2": ("0", "0", "-N@F2", "x(E0,F2)@D", "q0-M@E0", "q0-M@E0"),
    "E1 F0": ("0", "N@F0", "0", "x(E1,F0)@D", "q0", "q0+M@E1"),
    "E1 F1": ("0", "N@F1", "0", "x(E1,F1)@D", "q0-M@E1", "q0"),
    "E1 F2": ("0", "N@F2", "0", "x(E1,F2)@D", "q0-M@E1", "q0-M@E1"),
    "E2 F0": ("0", "N@F0", "N@F0", "x(E2,F0)@D", "q0", "q0+M@E2"),
    "E2 F1": ("0", "N@F1", "N@F1", "x(E2,F1)@D", "q0-M@E2", "q0"),
    "E2 F2": ("0", "N@F2", "N@F2", "x(E2,F2)@D", "q0-M@E2", "q0-M@E2"),
}

# Table 6: the same of coplanar triangles; l2 = |N|^2, lij = lambda_ij.
TABLE_6 = {
    "N": ("0", "0", "0", "N@D", "q0", "q0"),
    "N E0": ("0", "0", "l2", "x(N,E0)@D", "q0+l00*l2", "q0+l01*l2"),
    "N E1": ("0", "-l2", "0", "x(N,E1)@D", "q0+l10*l2", "q0+l11*l2"),
    "N E2": ("0", "-l2", "-l2", "x(N,E2)@D", "q0+(l10-l00)*l2", "q0+(l11-l01)*l2"),
    "N F0": ("0", "-l00*l2", "-l10*l2", "x(N,F0)@D", "q0", "q0+mu*l2"),
    "N F1": ("0", "-l01*l2", "-l11*l2", "x(N,F1)@D", "q0-mu*l2", "q0"),
    "N F2": ("0", "(l00-l01)*l2", "(l10-l11)*l2", "x(N,F2)@D", "q0-mu*l2", "q0-mu*l2"),
}

# Table 7, rows E_i x F_j: (x_0, x_1) where 0 = max(sigma p_k), and where 0 = min(sigma p_k).
# Row N: the vertex of B with the least sigma q_k. Row M: the vertex of A with the greatest
# sigma p_k, printed the least (32).
TABLE_7 = {
    0: (("M@D/(M@E0)", "0"), ("0", "1")),
    1: (("0", "M@D/(M@E1)"), ("1", "0")),
    2: (("0", "0"), ("(M@E1-M@D)/(M@E2)", "1-(M@E1-M@D)/(M@E2)")),
}


def evaluate(expression: str, quantities: dict[str, Any]) -> float:
    """Return the value of an entry."""
    return float(eval(expression, {"__builtins__": {}} | quantities))


def vectors(prefix: str, rows: Any) -> dict[str, Any]:
    """Return rows (or numbers) under the names prefix0, prefix1, ..."""
    return {f"{prefix}{k}": row for k, row in enumerate(rows)}


FUNCTIONS: dict[str, Any] = {"x": np.cross, "sgn": np.sign, "abs": abs, "sum": sum}


def box_quantities(
    frame_a: Floats, half_a: Floats, frame_b: Floats, half_b: Floats, d: Floats, w: Floats
) -> dict[str, Any]:
    """Return what Tables 1, 1' and 2 speak of; frames have the axes as rows, d is C_1 - C_0."""
    c = frame_a @ frame_b.T
    return (
        FUNCTIONS
        | vectors("A", frame_a)
        | vectors("B", frame_b)
        | vectors("a", half_a)
        | vectors("b", half_b)
        | {f"c{i}{j}": c[i, j] for i in range(3) for j in range(3)}
        | vectors("al", frame_a @ w)
        | vectors("be", frame_b @ w)
        | {"a": half_a, "b": half_b, "c": c, "D": d, "W": w}
    )


def edges(triangle: Floats) -> Floats:
    """Return the paper's E_0 = U_1 - U_0, E_1 = U_2 - U_0 and E_2 = E_1 - E_0."""
    e0, e1 = triangle[1] - triangle[0], triangle[2] - triangle[0]
    return np.array([e0, e1, e1 - e0])


def axis(name: str, quantities: dict[str, Any]) -> Floats:
    """Return L by its name: one vector, or two that are crossed."""
    parts = [quantities[part] for part in name.split()]
    return np.asarray(parts[0] if len(parts) == 1 else np.cross(*parts))


def frame(rng: Any) -> Any:
    """Return right-handed orthonormal axes as rows, as the paper has them."""
    q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return q * np.sign(np.linalg.det(q))
