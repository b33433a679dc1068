from collections.abc import Sequence
import enum
from typing import Annotated

import numpy
from numpy.typing import NDArray


class TreeError(RuntimeError):
    pass

def keeps_denormals() -> bool: ...

class Fit(enum.Enum):
    TRIANGLES = 0

    POINTS = 1

    AXIS_ALIGNED = 2

class Split(enum.Enum):
    MEDIAN = 0

    CENTER = 1

class Tree:
    def __init__(self, vertices: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], corners: Annotated[NDArray[numpy.uint32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangle_ids: Annotated[NDArray[numpy.uint32], dict(shape=(None,), order='C', device='cpu', writable=False)], nodes: Annotated[NDArray[numpy.uint8], dict(shape=(None, 64), order='C', device='cpu', writable=False)], scale_exponent: int) -> None: ...

    def check(self, leaf_size: int, max_depth: int) -> str | None: ...

    def levels(self) -> list[tuple[int, int, float]]: ...

class TreeBuilder:
    def __init__(self, vertices: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], corners: Annotated[NDArray[numpy.uint32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], fit: Fit, split: Split, leaf_size: int, max_depth: int) -> None: ...

    def advance(self, work: int) -> bool: ...

    def progress(self) -> float: ...

    def finish(self) -> tuple[Annotated[NDArray[numpy.uint8], dict(shape=(None, 64), writable=False)], Annotated[NDArray[numpy.uint32], dict(shape=(None,), writable=False)], int]: ...

class Pose:
    def __init__(self, rotation: Annotated[NDArray[numpy.float64], dict(shape=(3, 3), order='C', writable=False)], translation: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C', writable=False)]) -> None: ...

class StaticQuery:
    def __init__(self, a: Tree, pose_a: Pose, b: Tree, pose_b: Pose, all_pairs: bool, boxes_for_leaves: bool, max_depth_a: int, max_depth_b: int, limit: int) -> None: ...

    def advance(self, max_pops: int) -> bool: ...

    def pairs(self) -> Annotated[NDArray[numpy.int64], dict(shape=(None, 2), writable=False)]: ...

    @property
    def is_contact(self) -> bool: ...

    @property
    def is_by_boxes(self) -> bool: ...

    @property
    def error_bound(self) -> float: ...

    def counts(self) -> tuple[int, int, int, int]: ...

class Evidence(enum.Enum):
    NONE = 0

    INTERSECTING = 1

    WITHIN_TOLERANCE = 2

    BOXES = 3

class Screw:
    def __init__(self, linear_velocity: Sequence[float], angular_velocity: Sequence[float], pivot: Sequence[float]) -> None: ...

class Contact:
    @property
    def low(self) -> float: ...

    @property
    def high(self) -> float: ...

    @property
    def evidence(self) -> Evidence: ...

    @property
    def triangle_a(self) -> int: ...

    @property
    def triangle_b(self) -> int: ...

    @property
    def ranges(self) -> tuple[int, int, int, int]: ...

    @property
    def distance(self) -> float: ...

    @property
    def error_bound(self) -> float: ...

class ContactQuery:
    def __init__(self, a: Tree, pose_a: Pose, screw_a: Screw, b: Tree, pose_b: Pose, screw_b: Screw, *, duration: float, time_tolerance: float, distance_tolerance: float, clearance: float, boxes_for_leaves: bool, max_depth_a: int, max_depth_b: int, any_contact: bool, each_pair: bool) -> None: ...

    def advance(self, max_pops: int) -> bool: ...

    @property
    def lower_bound(self) -> float: ...

    @property
    def has_given_up(self) -> bool: ...

    def contact(self) -> Contact | None: ...

    def take(self) -> Contact | None: ...

    def place(self, arg: Contact, /) -> tuple[list[float], list[float], list[float], list[float], list[float], int, int]: ...

    def counts(self) -> tuple[int, int, int, int]: ...

def primitive_intersects(a: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], b: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], velocity_a: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], velocity_b: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], duration: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], threads: int, verdicts: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu')]) -> None: ...

def primitive_first_contacts(a: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], b: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], velocity_a: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], velocity_b: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], duration: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], count: int, threads: int) -> dict: ...

class DistanceQuery:
    def __init__(self, a: Tree, pose_a: Pose, b: Tree, pose_b: Pose, boxes_for_leaves: bool, max_depth_a: int, max_depth_b: int, tolerance: float) -> None: ...

    def advance(self, max_pops: int) -> bool: ...

    def bounds(self) -> tuple[float, float, tuple[float, float, float], tuple[float, float, float], int, int]: ...

    def counts(self) -> tuple[int, int, int, int]: ...
