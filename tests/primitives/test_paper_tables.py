"""Tables 1 to 4 of the paper against the shapes themselves, projected or brought into contact."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
import pytest
from oracles import paper_tables as paper

from obbcli.primitives import Obb, Triangle, first_contact

CLOSE = 1e-9
# Level, with an edge across the vertical edge x = y = 1 of a cube.
FLAT = np.array([[0.5, 1.5, 0.25], [1.5, 0.5, 0.25], [2, 2, 0.25]])
CORNERS = np.array(list(product((-1, 1), repeat=3)))
RUNS = 40


def boxes(rng: Any) -> tuple[Any, Any, Any, Any]:
    return paper.frame(rng), rng.uniform(0.2, 2, 3), paper.frame(rng), rng.uniform(0.2, 2, 3)


def spread(values: Any) -> tuple[float, float]:
    """Return the middle and the radius of an interval that holds the values."""
    return (values.max() + values.min()) / 2, (values.max() - values.min()) / 2


@pytest.mark.parametrize(("name", "row"), [*paper.TABLE_1.items(), *paper.TABLE_1_PRIME.items()])
def test_tables_1_and_1_prime_are_radii_and_distance_of_projections(name: str, row: Any) -> None:
    rng = np.random.default_rng(1)
    for _ in range(RUNS):
        frame_a, half_a, frame_b, half_b = boxes(rng)
        d, w = rng.normal(size=(2, 3))
        q = paper.box_quantities(frame_a, half_a, frame_b, half_b, d, w)
        axis = paper.axis(name, q)

        middle_a, radius_a = spread(((CORNERS * half_a) @ frame_a) @ axis)
        middle_b, radius_b = spread((d + (CORNERS * half_b) @ frame_b) @ axis)

        found = [paper.evaluate(entry, q) for entry in row]
        assert found == pytest.approx([radius_a, radius_b, abs(middle_b - middle_a)], abs=CLOSE)


def test_equation_2_signs_of_triple_products() -> None:
    signs = {(0, 1): 1, (1, 2): 1, (2, 0): 1, (1, 0): -1, (2, 1): -1, (0, 2): -1}
    frame_a, _, frame_b, _ = boxes(np.random.default_rng(2))
    c = frame_a @ frame_b.T

    for (i0, i1), sign in signs.items():
        i2 = 3 - i0 - i1
        for j in range(3):
            assert frame_a[i0] @ np.cross(frame_a[i1], frame_b[j]) == pytest.approx(sign * c[i2, j])
            turned = frame_b[i0] @ np.cross(frame_a[j], frame_b[i1])
            assert turned == pytest.approx(-sign * c[j, i2])


@pytest.mark.parametrize("sigma", [1, -1])
@pytest.mark.parametrize("i", range(3))
def test_table_2_face_rows_name_the_vertex_that_touches(i: int, sigma: int) -> None:
    rng = np.random.default_rng(3)
    for _ in range(RUNS):
        frame_a, half_a, frame_b, half_b = boxes(rng)
        c = frame_a @ frame_b.T

        # Row A_i: B's vertex on A's face. Row B_i with c_ji (erratum 16): A's vertex on B's face.
        y = -sigma * np.sign(c[i]) * half_b
        x = sigma * np.sign(c[:, i]) * half_a

        corners_b, corners_a = (CORNERS * half_b) @ frame_b, (CORNERS * half_a) @ frame_a
        assert sigma * (y @ frame_b) @ frame_a[i] == pytest.approx(
            (sigma * corners_b @ frame_a[i]).min()
        )
        assert sigma * (x @ frame_a) @ frame_b[i] == pytest.approx(
            (sigma * corners_a @ frame_b[i]).max()
        )


@pytest.mark.parametrize("sigma", [1, -1])
@pytest.mark.parametrize("name", list(paper.TABLE_2))
def test_table_2_edge_rows_give_the_point_where_edges_touch(name: str, sigma: int) -> None:
    rng = np.random.default_rng(4)
    i, j = int(name[1]), int(name[4])
    for _ in range(RUNS):
        frame_a, half_a, frame_b, half_b = boxes(rng)
        axis = sigma * np.cross(frame_a[i], frame_b[j])
        # The edges that look at each other along the axis, and a point on each.
        x = np.sign(frame_a @ axis) * half_a
        y = -np.sign(frame_b @ axis) * half_b
        x[i], y[j] = rng.uniform(-1, 1, 2) * (half_a[i], half_b[j])
        d = x @ frame_a - y @ frame_b
        q = paper.box_quantities(frame_a, half_a, frame_b, half_b, d, d) | {"sg": sigma}

        fixed = {key: paper.evaluate(entry, q) for key, entry in paper.TABLE_2[name].items()}
        last = paper.evaluate(paper.TABLE_2_LAST[name], q | fixed)

        chosen = paper.vectors("x", x) | paper.vectors("y", y)
        assert fixed == pytest.approx({key: chosen[key] for key in fixed})
        assert last == pytest.approx(x[i], abs=1e-6)


def triangle_and_box(rng: Any) -> dict[str, Any]:
    """Return what Tables 3 and 4 speak of, at a random place."""
    half, axes, triangle = rng.uniform(0.2, 2, 3), paper.frame(rng), rng.normal(size=(3, 3))
    return quantities_of(axes, half, triangle, np.zeros(3))


def quantities_of(axes: Any, half: Any, triangle: Any, center: Any) -> dict[str, Any]:
    e = paper.edges(triangle)
    return (
        paper.FUNCTIONS
        | paper.vectors("A", axes)
        | paper.vectors("a", half)
        | paper.vectors("E", e)
        | {"N": np.cross(e[0], e[1]), "D": triangle[0] - center, "A": axes}
        | {"half": half, "triangle": triangle}
    )


@pytest.mark.parametrize(("name", "row"), list(paper.TABLE_3.items()))
def test_table_3_is_the_box_radius_and_the_vertices_projections(name: str, row: Any) -> None:
    rng = np.random.default_rng(5)
    for _ in range(RUNS):
        q = triangle_and_box(rng)
        axis = paper.axis(name, q)

        _, radius = spread(((CORNERS * q["half"]) @ q["A"]) @ axis)
        places = q["triangle"] @ axis

        q["p0"] = paper.evaluate(row[1], q)
        found = [paper.evaluate(entry, q) for entry in row]
        assert found == pytest.approx([radius, *places], abs=CLOSE)


@pytest.mark.parametrize("sigma", [1, -1])
def test_table_4a_names_the_corner_or_vertex_that_touches(sigma: int) -> None:
    rng = np.random.default_rng(6)
    for _ in range(RUNS):
        q = triangle_and_box(rng)
        corners = (CORNERS * q["half"]) @ q["A"]

        # Row N: x_i = sigma Sign(N.A_i) a_i is the box's corner furthest along sigma N.
        x = sigma * np.sign(q["A"] @ q["N"]) * q["half"]
        assert sigma * (x @ q["A"]) @ q["N"] == pytest.approx((sigma * corners @ q["N"]).max())

        # Row A_i: (y_0, y_1) is the vertex of least sigma p_k.
        for i, (y0, y1) in product(range(3), ((0, 0), (1, 0), (0, 1))):
            p = sigma * q["triangle"] @ q["A"][i]
            place = q["D"] + y0 * q["E0"] + y1 * q["E1"]
            assert sigma * place @ q["A"][i] == pytest.approx(p[y0 + 2 * y1])


@pytest.mark.parametrize("case", [0, 1])
@pytest.mark.parametrize(("i", "j"), list(product(range(3), range(3))))
def test_tables_4b_to_4d_give_the_point_on_the_box_edge(i: int, j: int, case: int) -> None:
    rng = np.random.default_rng(7)
    others = [k for k in range(3) if k != i]
    name, *values = paper.TABLE_4_TRIANGLE[j]
    for _ in range(RUNS):
        q = triangle_and_box(rng)
        axis = np.cross(q["A"][i], q[f"E{j}"])
        # In the table's case 0 the triangle touches where p_0 is extreme, in case 1 opposite.
        p = q["triangle"] @ axis
        touching = p[0] if case == 0 else p[np.argmax(np.abs(p - p[0]))]
        sigma = 1 if touching <= p.min() + CLOSE else -1
        x = sigma * np.sign(q["A"] @ axis) * q["half"]
        x[i] = rng.uniform(-1, 1) * q["half"][i]
        y0, y1 = place_on(j, values[case], rng.uniform())
        shift = x @ q["A"] - (q["D"] + y0 * q["E0"] + y1 * q["E1"])
        q = quantities_of(q["A"], q["half"], q["triangle"] + shift, np.zeros(3))
        q |= {"sg": sigma, "E": q[f"E{j}"], "i": i, "others": others}

        fixed = {k: paper.evaluate(e, q) for k, e in paper.TABLE_4_FIXED[i].items()}
        q |= {"X": [fixed.get(f"x{k}", 0.0) for k in range(3)], "y": values[case]}
        last = paper.evaluate(paper.TABLE_4_LAST[j], q)

        assert paper.evaluate(name, {"y0": y0, "y1": y1}) == pytest.approx(values[case])
        assert fixed == pytest.approx({f"x{k}": x[k] for k in others})
        assert last == pytest.approx(x[i], abs=1e-6)


def place_on(j: int, value: int, s: float) -> tuple[float, float]:
    """Return (y_0, y_1) on edge j, or at the vertex opposite to it, as Tables 4b to 4d have it."""
    if j == 2:
        return (0.0, 0.0) if value == 0 else (1 - s, s)
    if value == 1:
        return (0.0, 1.0) if j == 0 else (1.0, 0.0)
    return (s, 0.0) if j == 0 else (0.0, s)


def test_tables_4b_to_4d_are_zero_over_zero_where_a_box_axis_is_the_normal() -> None:
    """Erratum 23: the contact is unique all the same, and solving for the two lines gives it."""
    cube = quantities_of(np.eye(3), np.ones(3), FLAT, np.zeros(3)) | {"i": 2, "others": [0, 1]}
    edge, axis = cube["E0"], np.array([0.0, 0.0, 1.0])
    cube |= {"X": [1.0, 1.0, 0.0], "y": 0.0}

    numerator, denominator = paper.TABLE_4_LAST[0].rsplit("/", 1)

    assert paper.evaluate(numerator, cube) == 0
    assert paper.evaluate(denominator, cube) == 0
    # The box's edge is (1, 1, x_2), the triangle's U_0 + s E_0.
    across = np.cross(axis, edge)
    assert np.cross(FLAT[0] - [1, 1, 0], edge) @ across / (across @ across) == 0.25
    contact: Any = first_contact(Obb([0, 0, 0], np.eye(3), [1, 1, 1]), Triangle(FLAT))
    assert contact.feature == "edge-edge"
    assert contact.point.tolist() == [1, 1, 0.25]
