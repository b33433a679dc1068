"""What `first_contact` answers: one contact, or the columns of many."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from obbcli.answers.words import FEATURES

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from obbcli.answers.words import FeatureWord

    Floats = NDArray[np.float64]
    Columns = Mapping[str, NDArray[Any]]

# In the order of the kernels' AxisKind, with how many indices each kind has.
_AXES = (
    ("", ()),
    ("face_a", (0,)),
    ("face_b", (1,)),
    ("edge_edge", (0, 1)),
    ("plane", ()),
    ("edge_a", (0,)),
    ("edge_b", (1,)),
    ("line", ()),
    ("across", (0,)),
    ("point", (0,)),
)
_KINDS = np.array([name for name, _ in _AXES])
_NORMALS = ("normal", "normal_a", "normal_b", "smooth_normal_a", "smooth_normal_b")
_FEATURES = np.array([word or "" for word in FEATURES])


class SeparatingAxis(NamedTuple):
    """The axis L that was the last to separate two shapes (of several the first in the list).

    Edge k of a triangle runs from vertex k to vertex k + 1 (modulo 3) and its face normal is
    edge 0 x edge 1; the edges and the face normals of a box are its axes. Kinds: `"face_a"`,
    `"face_b"`: that normal; `"edge_edge"`: edge of A x edge of B. Where all edges are parallel to
    a plane, `"plane"`: its normal, `"edge_a"`, `"edge_b"`: that normal x an edge. Where all are
    parallel to a line, `"line"`, and `"across"`: a coordinate axis x that line; and for two
    points `"point"`: a coordinate axis.

    Attributes:
        kind: see above.
        indices: of the face or edge of A, of B, of both for `"edge_edge"`, or of the coordinate
            axis; empty where the kind says all.
        side: 1 where B is on the side that L points to, -1 on the other.
    """

    kind: str
    indices: tuple[int, ...]
    side: int


@dataclass(frozen=True, eq=False)
class PrimitiveContact:
    """The first contact of two shapes.

    Attributes:
        time: s; the double nearest to the exact first time.
        time_below: s; the largest double that is not later than the exact first time.
        last_time: s; the last time of contact in [0, duration].
        ends: whether contact ends before the duration.
        point: (3,) world coordinates at `time`, in both shapes to rounding.
        separating_axis: the axis that ended last; None where the shapes overlap at the start.
        normal: (3,) unit vector along it from A to B; None without axis.
        feature: the smallest parts that hold all common points, of A then of B:
            `"vertex-face"`, `"edge-edge"`, ...; None without axis.
        normal_a: (3,) unit normal out of the face of A that meets B; where a feature lies in
            several faces, of the one that points to B best. A triangle's points to B. None where a
            box overlaps at the start, or a triangle has no area there.
        normal_b: the same of B.
        smooth_normal_a: (3,) a box's normal at `point` as if it were an ellipsoid (Eberly 2008
            §7.2), which turns smoothly over its faces; a triangle's and a flat box's `normal_a`.
        smooth_normal_b: the same of B.
    """

    time: float
    time_below: float
    last_time: float
    ends: bool
    point: Floats
    separating_axis: SeparatingAxis | None
    normal: Floats | None
    feature: FeatureWord | None
    normal_a: Floats | None
    normal_b: Floats | None
    smooth_normal_a: Floats | None
    smooth_normal_b: Floats | None


@dataclass(frozen=True, eq=False)
class PrimitiveContacts:
    """The first contacts of the M pairs that meet, of N asked; all arrays are read-only.

    `contacts[k]` is the k-th of them as a `PrimitiveContact`, which says what each field means.

    Attributes:
        rows: int64 (M,), ascending: which pairs they are. Rows that are not here never meet.
        time: float64 (M,).
        time_below: float64 (M,).
        last_time: float64 (M,).
        ends: bool (M,).
        point: float64 (M, 3).
        normal: float64 (M, 3); as the normals below, zero where there is none.
        normal_a: float64 (M, 3).
        normal_b: float64 (M, 3).
        smooth_normal_a: float64 (M, 3).
        smooth_normal_b: float64 (M, 3).
        axis_kind: str (M,): `SeparatingAxis.kind`, empty where the shapes overlap at the start.
        feature: str (M,), empty where the shapes overlap at the start.
    """

    rows: NDArray[np.int64]
    time: Floats
    time_below: Floats
    last_time: Floats
    ends: NDArray[np.bool_]
    point: Floats
    normal: Floats
    normal_a: Floats
    normal_b: Floats
    smooth_normal_a: Floats
    smooth_normal_b: Floats
    axis_kind: NDArray[np.str_]
    feature: NDArray[np.str_]
    _columns: Columns

    def __len__(self) -> int:
        return len(self.rows)

    def __getitem__(self, k: int) -> PrimitiveContact:
        """Return the k-th contact."""
        return contact_at(self._columns, k)


def contact_at(columns: Columns, k: int) -> PrimitiveContact:
    """Return the k-th contact of the kernel's columns."""
    kind, first, second, side, feature, ends = columns["codes"][k].tolist()
    name, places = _AXES[kind]
    indices = (first, second)
    axis = SeparatingAxis(name, tuple(indices[i] for i in places), side) if kind else None
    return PrimitiveContact(
        time=float(columns["time"][k]),
        time_below=float(columns["time_below"][k]),
        last_time=float(columns["last_time"][k]),
        ends=bool(ends),
        point=columns["point"][k],
        separating_axis=axis,
        feature=FEATURES[feature],
        **{name: v if (v := columns[name][k]).any() else None for name in _NORMALS},
    )


def contacts_of(columns: Columns) -> PrimitiveContacts:
    """Return the kernel's columns as contacts."""
    codes = columns["codes"]
    derived = {
        "ends": codes[:, 5].astype(np.bool_),
        "axis_kind": _KINDS[codes[:, 0]],
        "feature": _FEATURES[codes[:, 4]],
    }
    for column in derived.values():
        column.setflags(write=False)
    plain = {name: column for name, column in columns.items() if name != "codes"}
    return PrimitiveContacts(**plain, **derived, _columns=columns)
