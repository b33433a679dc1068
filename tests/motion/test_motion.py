"""Poses and motions: what is accepted, what the numbers become, what is refused."""

from __future__ import annotations

import dataclasses
import math
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from oracles.mesh import posed

from obbcli import Body, Mesh, Motion, MotionError, Pose
from obbcli.motion.body import as_body
from obbcli.motion.rotation import rotation_matrix

TRIANGLE = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
COMPONENTS = st.floats(-20, 20) | st.floats(-1e-6, 1e-6) | st.sampled_from([0.0, 5e-324, 1e-160])


def rotation_by_series(vector: list[float]) -> np.ndarray:
    """Return exp of the cross-product matrix, to 40 digits: no closed form shared with the code."""
    x, y, z = vector
    with mpmath.workdps(60):
        return np.array(
            mpmath.expm(mpmath.matrix([[0, -z, y], [z, 0, -x], [-y, x, 0]])).tolist(), dtype=float
        )


def test_pose_without_arguments_is_the_identity():
    pose = Pose()

    np.testing.assert_array_equal(pose.rotation, np.eye(3))
    np.testing.assert_array_equal(pose.translation, np.zeros(3))
    assert pose.is_identity


def test_pose_takes_a_matrix_literally():
    matrix = np.eye(3) + 1e-11 * np.arange(9).reshape(3, 3)

    pose = Pose(rotation=matrix)

    np.testing.assert_array_equal(pose.rotation, matrix)
    assert not pose.is_identity


def test_pose_keeps_nothing_of_the_callers_arrays():
    matrix, shift = np.eye(3), np.zeros(3)
    pose = Pose(matrix, shift)

    matrix[0, 0], shift[0] = 5, 5

    assert pose.is_identity
    with pytest.raises(ValueError, match="read-only"):
        pose.translation[0] = 1
    with pytest.raises(dataclasses.FrozenInstanceError):
        pose.translation = shift


@given(st.lists(COMPONENTS, min_size=3, max_size=3))
def test_rotation_vector_becomes_the_matrix_exponential(vector):
    matrix = Pose(rotation=vector).rotation

    angle = math.hypot(*vector)
    # Entries are rounded, and so is the angle, which turns every entry by as much.
    np.testing.assert_allclose(matrix, rotation_by_series(vector), atol=4e-16 * (2 + angle), rtol=0)


def test_rotation_vector_of_zero_is_exactly_the_identity():
    assert Pose(rotation=(0.0, -0.0, 0.0)).is_identity


def test_tiny_rotation_vector_is_not_lost():
    matrix = rotation_matrix((0, 0, 1e-300))

    assert matrix[1, 0] == 1e-300
    assert matrix[0, 1] == -1e-300


@pytest.mark.parametrize("quarters", [-7, -2, -1, 1, 2, 3, 4, 5, 4_000_001])
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_quarter_turns_in_degrees_are_exact(axis, quarters):
    vector = np.zeros(3)
    vector[axis] = 90.0 * quarters
    one = np.zeros((3, 3), dtype=int)
    one[axis, axis] = 1
    one[(axis + 2) % 3, (axis + 1) % 3] = 1
    one[(axis + 1) % 3, (axis + 2) % 3] = -1

    matrix = rotation_matrix(vector, degrees=True)

    np.testing.assert_array_equal(matrix, np.linalg.matrix_power(one, quarters % 4))
    assert not np.signbit(matrix[matrix == 0]).any()


@given(st.lists(st.floats(-1e4, 1e4), min_size=3, max_size=3))
def test_degrees_turn_as_far_as_radians(vector):
    in_degrees = rotation_matrix(vector, degrees=True)

    radians = rotation_matrix(np.radians(vector))
    np.testing.assert_allclose(in_degrees, radians, atol=1e-12)


def test_apply_rounds_as_the_conventions_say():
    pose = Pose(rotation=(0.3, -1.1, 2.0), translation=(1e8, -0.1, 1e-3))
    points = np.random.default_rng(1).normal(size=(50, 3))

    np.testing.assert_array_equal(
        pose.apply(points), posed(points, pose.rotation, pose.translation)
    )
    exact = sum(
        Fraction(float(q)) * Fraction(float(p))
        for q, p in zip(pose.rotation[2], points[0], strict=True)
    ) + Fraction(1e-3)
    assert abs(Fraction(float(pose.apply(points)[0, 2])) - exact) < Fraction(1, 10**14)


def test_identity_pose_rounds_nothing():
    points = [[1e300, -0.1, 5e-324]]

    np.testing.assert_array_equal(Pose().apply(points), points)


@pytest.mark.parametrize(
    ("arguments", "where", "fault"),
    [
        ({"rotation": np.diag([1.0, 1.0, 1.0 + 1e-8])}, "rotation", "not orthonormal to 1e-09"),
        ({"rotation": 2 * np.eye(3)}, "rotation", "not orthonormal"),
        ({"rotation": np.full((3, 3), 1e300)}, "rotation", "not orthonormal"),
        ({"rotation": np.diag([1.0, 1.0, -1.0])}, "rotation", "is a reflection"),
        ({"rotation": np.eye(4)}, "rotation", r"shape \(4, 4\), expected \(3, 3\)"),
        ({"rotation": [[1.0, 0.0], [0.0]]}, "rotation", "expected numbers"),
        ({"rotation": 5.0}, "rotation", r"shape \(\), expected \(3, 3\)"),
        ({"rotation": [1.0, 2.0]}, "rotation", r"shape \(2,\), expected \(3\)"),
        ({"rotation": [1.7e308] * 3}, "rotation", "turns by inf"),
        ({"rotation": [0.0, math.nan, 0.0]}, r"rotation\[1\]", "is nan"),
        ({"translation": [0.0, 0.0, math.inf]}, r"translation\[2\]", "is inf"),
        ({"translation": ["x", 0, 0]}, "translation", "expected numbers"),
        ({"translation": [[0, 0, 0]]}, "translation", r"shape \(1, 3\)"),
    ],
)
def test_pose_refuses_what_is_no_pose(arguments, where, fault):
    with pytest.raises(MotionError, match=f"^{where}.*{fault}"):
        Pose(**arguments)


def test_pose_accepts_a_matrix_off_by_less_than_the_tolerance():
    assert not Pose(rotation=np.diag([1.0, 1.0, 1.0 + 4e-10])).is_identity


def test_motion_without_arguments_is_at_rest():
    motion = Motion()

    assert motion.is_at_rest
    assert motion.pivot is None


@pytest.mark.parametrize("name", ["linear_velocity", "angular_velocity"])
def test_motion_with_any_velocity_is_not_at_rest(name):
    assert not Motion(**{name: (0, 5e-324, 0)}).is_at_rest


def test_motion_with_a_pivot_alone_is_at_rest():
    motion = Motion(pivot=(1, 2, 3))

    assert motion.is_at_rest
    np.testing.assert_array_equal(motion.pivot, [1.0, 2.0, 3.0])


@pytest.mark.parametrize("name", ["linear_velocity", "angular_velocity", "pivot"])
@pytest.mark.parametrize(
    "value",
    [
        (1, 2),
        (1, 2, math.nan),
        "fast",
        (1, 2, math.inf),
        [[1, 2, 3]],
        (1, 2, 10**400),
        (1, 2, None),
    ],
)
def test_motion_refuses_what_is_no_vector(name, value):
    with pytest.raises(MotionError, match=f"^{name}"):
        Motion(**{name: value})


def test_body_is_taken_as_it_is():
    body = Body(TRIANGLE, Pose(translation=(1, 0, 0)))

    assert as_body(body) is body


def test_shapes_and_paths_become_bodies_at_rest(tmp_path):
    for shape in (TRIANGLE, "gear.stl", tmp_path / "gear.stl"):
        body = as_body(shape)

        assert body.shape is shape
        assert body.pose.is_identity
        assert body.motion.is_at_rest


@pytest.mark.parametrize(
    ("arguments", "where"),
    [
        ((None,), "shape"),
        ((7,), "shape"),
        ((TRIANGLE, (0, 0, 1)), "pose"),
        ((TRIANGLE, Pose(), (0, 0, 1)), "motion"),
    ],
)
def test_body_refuses_other_kinds_of_arguments(arguments, where):
    with pytest.raises(MotionError, match=f"^{where}: is of type"):
        Body(*arguments)


@pytest.mark.parametrize(
    "value",
    [
        Pose(),
        Pose(translation=(0.1, 0, -3e-300)),
        Pose(rotation=(0.1, 0.2, 0.3), translation=(1, 2, 3)),
        Motion(),
        Motion((0, 0, -2)),
        Motion(angular_velocity=(0, 0, 3), pivot=(0.1, 0, 0)),
    ],
)
def test_what_is_shown_makes_the_same_again(value):
    again = eval(repr(value))

    assert repr(again) == repr(value)
    assert vars(again).keys() <= vars(value).keys() | {"is_identity"}
    for name, part in vars(again).items():
        np.testing.assert_array_equal(part, getattr(value, name))


def test_what_is_not_given_is_not_shown():
    assert repr(Pose()) == "Pose()"
    assert repr(Motion()) == "Motion()"
    assert repr(Motion((0, 0, 1))) == "Motion(linear_velocity=[0.0, 0.0, 1.0])"
