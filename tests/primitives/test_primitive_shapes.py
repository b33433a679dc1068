"""Bad input of the pair questions: each refused in words, arrays with the first row at fault."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from obbcli.errors import MotionError, ObbError
from obbcli.primitives import Obb, Triangle, first_contact, intersects

EYE = np.eye(3)
BOX = Obb([0, 0, 0], EYE, [1, 1, 1])
FOUR = Triangle(np.zeros((4, 3, 3)))


def boxes(**changed: Any) -> tuple[Any, Any, Any]:
    """Return valid arrays for three boxes, with some replaced."""
    valid = {
        "center": np.zeros((3, 3)),
        "axes": np.array([EYE] * 3),
        "half_extents": np.ones((3, 3)),
    }
    return tuple((valid | changed).values())  # type: ignore[return-value]


@pytest.mark.parametrize(
    ("arguments", "where", "fault"),
    [
        (([0, 0, np.nan], EYE, [1, 1, 1]), "center[2]", "nan"),
        (([0, 0, 0], EYE, [1, np.inf, 1]), "half_extents[1]", "inf"),
        (([0, 0, 0], EYE, [1, -1e-300, 1]), "half_extents", "-1e-300"),
        (([0, 0, 0], 2 * EYE, [1, 1, 1]), "axes", "orthonormal"),
        (([0, 0, 0], EYE + 1e-8, [1, 1, 1]), "axes", "orthonormal"),
        (([0, 0, 0], 1e308 * EYE, [1, 1, 1]), "axes", "orthonormal"),
        (([0, 0], EYE, [1, 1, 1]), "center", "shape (2,)"),
        (([0, 0, 0], EYE[:2], [1, 1, 1]), "axes", "shape (2, 3)"),
        (([0, 0, 0], EYE, "wide"), "half_extents", "numbers"),
        (([[0, 0, 0], [1]], EYE, [1, 1, 1]), "center", "numbers"),
        (([0, 0, 0], [EYE], [1, 1, 1]), "Obb", "1 axes"),
        (boxes(center=np.zeros((2, 3))), "Obb", "2 centers"),
        (boxes(half_extents=[[1, 1, 1], [1, 1, -2], [0, 0, -1]]), "half_extents[1]", "-2.0"),
        (boxes(axes=[EYE, EYE, EYE[[0, 0, 2]]]), "axes[2]", "orthonormal"),
        (boxes(center=[[0, 0, 0], [0, 0, 0], [0, -np.inf, 0]]), "center[2, 1]", "-inf"),
    ],
)
def test_obb_refuses(arguments: Any, where: str, fault: str) -> None:
    with pytest.raises(ObbError) as caught:
        Obb(*arguments)

    assert caught.value.where == where
    assert fault in str(caught.value)


@pytest.mark.parametrize(
    ("vertices", "where"),
    [
        ([0, 1, 2], "vertices"),
        (np.zeros((3, 2)), "vertices"),
        (np.zeros((2, 3, 2)), "vertices"),
        ([[0, 0, 0], [0, 0, 0], [0, 0, np.nan]], "vertices[2, 2]"),
        ([np.zeros((3, 3)), np.full((3, 3), np.inf)], "vertices[1, 0, 0]"),
    ],
)
def test_triangle_refuses(vertices: Any, where: str) -> None:
    with pytest.raises(ObbError) as caught:
        Triangle(vertices)

    assert caught.value.where == where


@pytest.mark.parametrize(
    ("changed", "where"),
    [
        ({"velocity_a": 1.0}, "velocity_a"),
        ({"velocity_a": [1, 2]}, "velocity_a"),
        ({"velocity_b": [1, 2, np.nan]}, "velocity_b[2]"),
        ({"velocity_b": [[0, 0, 0]] * 3 + [[0, np.inf, 0]]}, "velocity_b[3, 1]"),
        ({"duration": -1e-300}, "duration"),
        ({"duration": np.inf}, "duration"),
        ({"duration": np.nan}, "duration"),
        ({"duration": 10**400}, "duration"),
        ({"duration": [0, 1, -2, -3]}, "duration[2]"),
        ({"duration": [[0]]}, "duration"),
        ({"duration": "long"}, "duration"),
    ],
)
@pytest.mark.parametrize("question", [intersects, first_contact])
def test_questions_refuse_motion(question: Any, changed: Any, where: str) -> None:
    with pytest.raises(MotionError) as caught:
        question(BOX, FOUR, **changed)

    assert caught.value.where == where


@pytest.mark.parametrize(
    ("arguments", "options", "where"),
    [
        ((BOX, EYE), {}, "shape_b"),
        ((None, BOX), {}, "shape_a"),
        ((FOUR, Triangle(np.zeros((3, 3, 3)))), {}, "shape_b"),
        ((FOUR, BOX, np.zeros((5, 3))), {}, "velocity_a"),
        ((BOX, FOUR, 0, 0, np.zeros(3)), {}, "duration"),
        ((BOX, FOUR), {"threads": 0}, "threads"),
        ((BOX, FOUR), {"threads": 1.5}, "threads"),
    ],
)
@pytest.mark.parametrize("question", [intersects, first_contact])
def test_questions_refuse_arguments(
    question: Any, arguments: Any, options: Any, where: str
) -> None:
    with pytest.raises(ObbError) as caught:
        question(*arguments, **options)

    assert caught.value.where == where


def test_contact_out_of_the_range_of_doubles_is_refused() -> None:
    triangle = Triangle([[1e300, 0, 0], [1e300, 1, 0], [1e300, 0, 1]])

    with pytest.raises(MotionError, match="range of doubles"):
        first_contact(triangle, BOX, [1e300, 0, 0], [1e300 + 1e290, 0, 0], 1e11)


def test_left_handed_and_flat_boxes_are_boxes() -> None:
    box = Obb([0, 0, 0], EYE[[1, 0, 2]], [1, 0, 2])

    assert intersects(box, box)
    assert box.axes.tolist() == EYE[[1, 0, 2]].tolist()
    assert not box.center.flags.writeable


def test_one_argument_goes_with_arrays_of_the_others() -> None:
    far = np.array([[0, 0, 0], [5, 0, 0], [9, 0, 0]])
    boxes_b = Obb(far, [EYE] * 3, np.ones((3, 3)))

    assert np.asarray(intersects(BOX, boxes_b)).tolist() == [True, False, False]
    assert np.asarray(intersects(boxes_b, BOX, duration=[0, 0, 0])).tolist() == [True, False, False]
    assert np.asarray(intersects(BOX, boxes_b, [1, 0, 0], 0, 4)).tolist() == [True, True, False]
    assert np.asarray(intersects(BOX, BOX, duration=[0.0, 1.0])).tolist() == [True, True]


def test_empty_arrays_have_empty_answers() -> None:
    none = Triangle(np.zeros((0, 3, 3)))

    assert np.asarray(intersects(none, BOX)).shape == (0,)
    assert len(first_contact(none, BOX)) == 0  # type: ignore[arg-type]
    assert len(Obb(np.zeros((0, 3)), np.zeros((0, 3, 3)), np.zeros((0, 3))).rows) == 0


def test_writing_to_the_source_changes_no_shape() -> None:
    vertices = np.zeros((3, 3))
    triangle = Triangle(vertices)

    vertices[:] = 9

    assert not triangle.vertices.any()


def test_repr_says_what_a_shape_is() -> None:
    assert repr(Triangle(EYE)) == f"Triangle({EYE.tolist()})"
    assert repr(FOUR) == "<Triangle: 4 triangles>"
    assert repr(BOX).startswith("Obb([0.0, 0.0, 0.0], [[1.0")
    assert repr(Obb(*boxes())) == "<Obb: 3 boxes>"
