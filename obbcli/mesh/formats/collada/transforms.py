"""The transforms of COLLADA's nodes as matrices (1.4.1, chapter 5: `node`)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from obbcli.mesh.formats.gltf.nodes import composed

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from obbcli.mesh.formats.collada.values import Values
    from obbcli.mesh.formats.safe_xml import Element

    #: (4, 4), applied to columns; None stands for the identity.
    Matrix = NDArray[np.float64] | None

_KINDS = ("lookat", "matrix", "rotate", "scale", "skew", "translate")
#: Last rows are rounded to float32, or to a few digits of a text.
_ROUNDING = 1e-3


def local_matrix(values: Values, node: Element) -> Matrix:
    """Return the product of a node's transforms in the order in which they stand.

    Raises:
        MeshError: numbers that are none, too many or too few; an axis of no length; a projection;
            a skew, which COLLADA does not define well enough to be read.
    """
    matrix: Matrix = None
    for element in node.named(*_KINDS):
        with np.errstate(over="ignore", invalid="ignore"):  # what is not finite is refused later
            matrix = composed(matrix, _matrix(values, element))
    return matrix


def _matrix(values: Values, element: Element) -> NDArray[np.float64]:
    result = np.eye(4)
    if element.name == "matrix":
        return affine(values, element)
    if element.name == "translate":
        result[:3, 3] = values.numbers(element, 3)
    elif element.name == "scale":
        result[range(3), range(3)] = values.numbers(element, 3)
    elif element.name == "rotate":
        x, y, z, degrees = values.numbers(element, 4).tolist()
        result[:3, :3] = _rotation(values, element, [x, y, z], degrees)
    elif element.name == "lookat":
        eye, interest, up = values.numbers(element, 9).reshape(3, 3)
        back = _unit(values, element, eye - interest)
        right = _unit(values, element, np.cross(up, back))
        result[:3] = np.stack([right, np.cross(back, right), back, eye], axis=1)
    else:
        remedy = "apply the node's transforms to its mesh, or write a <matrix>"
        raise values.error(element, "<skew> is not read", remedy)
    return result


def affine(values: Values, element: Element) -> NDArray[np.float64]:
    """Return the matrix (4, 4) that an element lists by rows."""
    matrix = values.numbers(element, 16).reshape(4, 4)
    if not (np.abs(matrix[3] - [0.0, 0.0, 0.0, 1.0]) <= _ROUNDING).all():
        fault = f"<{element.name}> has a last row that is not 0 0 0 1"
        raise values.error(element, fault)
    matrix[3] = [0.0, 0.0, 0.0, 1.0]
    return matrix


def _rotation(
    values: Values, element: Element, axis: list[float], degrees: float
) -> NDArray[np.float64]:
    """Return the rotation (3, 3) about an axis; quarter turns about x, y and z are exact."""
    if degrees == 0.0:
        return np.eye(3)
    x, y, z = _unit(values, element, np.array(axis)).tolist()
    cos, sin = _cos_sin(degrees)
    rest = 1.0 - cos
    return np.array(
        [
            [cos + rest * x * x, rest * x * y - sin * z, rest * x * z + sin * y],
            [rest * x * y + sin * z, cos + rest * y * y, rest * y * z - sin * x],
            [rest * x * z - sin * y, rest * y * z + sin * x, cos + rest * z * z],
        ]
    )


def _cos_sin(degrees: float) -> tuple[float, float]:
    """Return cosine and sine of an angle, exact for quarter turns."""
    turned = math.fmod(degrees, 360.0)
    quarter, left = divmod(turned, 90.0)
    if left == 0.0:
        return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[int(quarter) % 4]
    return math.cos(math.radians(turned)), math.sin(math.radians(turned))


def _unit(values: Values, element: Element, vector: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return a vector of length 1."""
    length = math.hypot(*vector.tolist())
    if not 0.0 < length < math.inf:
        raise values.error(element, f"<{element.name}> has an axis of no length")
    return vector / length
