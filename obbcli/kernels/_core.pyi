from collections.abc import Sequence
import enum
from typing import Annotated

import numpy
from numpy.typing import NDArray

class TreeError(RuntimeError):
    pass

def keeps_denormals() -> bool: ...
def convex_hull(
    points: Annotated[
        NDArray[numpy.float64], dict(shape=(None, 3), order="C", device="cpu", writable=False)
    ],
    max_vertices: int,
) -> tuple[
    int,
    Annotated[NDArray[numpy.uint32], dict(shape=(None,), writable=False)],
    Annotated[NDArray[numpy.uint32], dict(shape=(None, 3), writable=False)],
]: ...

class Fit(enum.Enum):
    TRIANGLES = 0

    POINTS = 1

    HULL = 2

    MIN_VOLUME = 3

    AXIS_ALIGNED = 4

class Split(enum.Enum):
    MEDIAN = 0

    CENTER = 1

    COMPACT = 2

class Tree:
    def __init__(
        self,
        vertices: Annotated[
            NDArray[numpy.float64], dict(shape=(None, 3), order="C", device="cpu", writable=False)
        ],
        corners: Annotated[
            NDArray[numpy.uint32], dict(shape=(None, 3), order="C", device="cpu", writable=False)
        ],
        triangle_ids: Annotated[
            NDArray[numpy.uint32], dict(shape=(None,), order="C", device="cpu", writable=False)
        ],
        nodes: Annotated[
            NDArray[numpy.uint8], dict(shape=(None, 64), order="C", device="cpu", writable=False)
        ],
        scale_exponent: int,
    ) -> None: ...
    def check(self, leaf_size: int, max_depth: int) -> str | None: ...
    def levels(self) -> list[tuple[int, int, float]]: ...
    def boxes_of_level(
        self, level: int
    ) -> tuple[
        Annotated[NDArray[numpy.uint32], dict(shape=(None, 4), writable=False)],
        Annotated[NDArray[numpy.float64], dict(shape=(None, 15), writable=False)],
        int,
    ]: ...
    def last_boxes_under(
        self, slot: int
    ) -> (
        tuple[
            Annotated[NDArray[numpy.uint32], dict(shape=(None, 4), writable=False)],
            Annotated[NDArray[numpy.float64], dict(shape=(None, 15), writable=False)],
            int,
        ]
        | None
    ): ...
    @property
    def node_count(self) -> int: ...
    @property
    def possible_node_count(self) -> int: ...
    @possible_node_count.setter
    def possible_node_count(self, arg: int, /) -> None: ...

class TreeBuilder:
    def __init__(
        self,
        vertices: Annotated[
            NDArray[numpy.float64], dict(shape=(None, 3), order="C", device="cpu", writable=False)
        ],
        corners: Annotated[
            NDArray[numpy.uint32], dict(shape=(None, 3), order="C", device="cpu", writable=False)
        ],
        fit: Fit,
        split: Split,
        leaf_size: int,
        max_depth: int,
        on_demand: bool,
        threads: int,
    ) -> None: ...
    def advance(self, work: int) -> bool: ...
    def progress(self) -> float: ...
    def tree(self) -> Tree: ...
    def arrays(
        self,
    ) -> tuple[
        Annotated[NDArray[numpy.uint8], dict(shape=(None, 64), writable=False)],
        Annotated[NDArray[numpy.uint32], dict(shape=(None, 3), writable=False)],
        Annotated[NDArray[numpy.uint32], dict(shape=(None,), writable=False)],
    ]: ...
    @property
    def scale_exponent(self) -> int: ...
    @property
    def node_count(self) -> int: ...
    @property
    def byte_count(self) -> int: ...

def crc32(
    data: Annotated[
        NDArray[numpy.uint8], dict(shape=(None,), order="C", device="cpu", writable=False)
    ],
) -> int: ...
def crc32_by_tables(
    data: Annotated[
        NDArray[numpy.uint8], dict(shape=(None,), order="C", device="cpu", writable=False)
    ],
) -> int: ...
def block_checksums(
    data: Annotated[
        NDArray[numpy.uint8], dict(shape=(None,), order="C", device="cpu", writable=False)
    ],
) -> Annotated[NDArray[numpy.uint32], dict(shape=(None,), writable=False)]: ...

class FileTree:
    def __init__(
        self,
        file: int,
        start: int,
        node_count: int,
        triangle_count: int,
        vertex_count: int,
        scale_exponent: int,
        checksums: Annotated[
            NDArray[numpy.uint32], dict(shape=(None,), order="C", device="cpu", writable=False)
        ],
    ) -> None: ...
    def tree(self) -> Tree: ...
    def arrays(
        self,
    ) -> tuple[
        Annotated[NDArray[numpy.uint8], dict(shape=(None, 64), writable=False)],
        Annotated[NDArray[numpy.uint32], dict(shape=(None, 3), writable=False)],
        Annotated[NDArray[numpy.uint32], dict(shape=(None,), writable=False)],
        Annotated[NDArray[numpy.float64], dict(shape=(None, 3), writable=False)],
    ]: ...
    def triangle_ids(
        self,
    ) -> Annotated[NDArray[numpy.uint32], dict(shape=(None,), writable=False)]: ...
    def triangle(
        self, position: int
    ) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), writable=False)]: ...
    @property
    def loaded_bytes(self) -> int: ...
    def loaded_counts(self) -> tuple[int, int]: ...
    @property
    def fault(self) -> str: ...

class Pose:
    def __init__(
        self,
        rotation: Annotated[NDArray[numpy.float64], dict(shape=(3, 3), order="C", writable=False)],
        translation: Annotated[NDArray[numpy.float64], dict(shape=(3), order="C", writable=False)],
    ) -> None: ...

class Placed:
    def __init__(self, tree: Tree, pose: Pose) -> None: ...

class Limits:
    def __init__(
        self,
        boxes_for_leaves: bool,
        max_depth_a: int,
        max_depth_b: int,
        max_pops: int,
        seconds: float,
    ) -> None: ...

def collide(
    arg0: Placed, arg1: Placed, arg2: Limits, /
) -> tuple[
    bool, bool, float, tuple[int, int] | None, float, tuple[int, int, int, int, int, int, int, int]
]: ...
def triangle_pairs(
    arg0: Placed, arg1: Placed, arg2: int, arg3: int, arg4: int, /
) -> tuple[
    Annotated[NDArray[numpy.int64], dict(shape=(None, 2), writable=False)] | None,
    tuple[int, int, int, int],
]: ...

class StaticQuery:
    def __init__(self, arg0: Placed, arg1: Placed, arg2: Limits, /) -> None: ...
    def advance(self, max_pops: int) -> bool: ...
    @property
    def is_contact(self) -> bool: ...
    @property
    def is_by_boxes(self) -> bool: ...
    @property
    def error_bound(self) -> float: ...
    def witness(self) -> tuple[int, int] | None: ...
    def counts(self) -> tuple[int, int, int, int]: ...

class Evidence(enum.Enum):
    NONE = 0

    INTERSECTING = 1

    WITHIN_TOLERANCE = 2

    BOXES = 3

class Screw:
    def __init__(
        self,
        linear_velocity: Sequence[float],
        angular_velocity: Sequence[float],
        pivot: Sequence[float],
    ) -> None: ...

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
    def __init__(
        self,
        a: Tree,
        pose_a: Pose,
        screw_a: Screw,
        b: Tree,
        pose_b: Pose,
        screw_b: Screw,
        *,
        duration: float,
        time_tolerance: float,
        distance_tolerance: float,
        clearance: float,
        boxes_for_leaves: bool,
        max_depth_a: int,
        max_depth_b: int,
        any_contact: bool,
        each_pair: bool,
    ) -> None: ...
    def advance(self, max_pops: int, until: float = float("inf")) -> bool: ...
    @property
    def lower_bound(self) -> float: ...
    @property
    def has_given_up(self) -> bool: ...
    def contact(self) -> Contact | None: ...
    def take(self) -> Contact | None: ...
    def place(
        self, arg: Contact, /
    ) -> tuple[list[float], list[float], list[float], list[float], list[float], int, int]: ...
    def counts(self) -> tuple[int, int, int, int]: ...

class SweepOptions:
    def __init__(
        self,
        *,
        distance_tolerance: float,
        clearance: float,
        boxes_for_leaves: bool,
        max_depth_a: int,
        max_depth_b: int,
        max_pops: int,
        seconds: float,
    ) -> None: ...

def sweep(
    a: Tree,
    b: Tree,
    placements: Annotated[
        NDArray[numpy.float64], dict(shape=(None, 24), order="C", device="cpu", writable=False)
    ],
    questions: Annotated[
        NDArray[numpy.float64], dict(shape=(None, 20), order="C", device="cpu", writable=False)
    ],
    options: SweepOptions,
    threads: int,
) -> tuple[
    Annotated[NDArray[numpy.uint8], dict(shape=(None, 232), writable=False)],
    list[tuple[int, bool, str]],
]: ...
def first_triangles_of_parts(
    corners: Annotated[
        NDArray[numpy.int64], dict(shape=(None, 3), order="C", device="cpu", writable=False)
    ],
    position_count: int,
) -> Annotated[NDArray[numpy.int64], dict(shape=(None,), writable=False)]: ...

class ContainmentQuery:
    def __init__(
        self,
        tree: Tree,
        pose: Pose,
        points: Annotated[
            NDArray[numpy.float64], dict(shape=(None, 3), order="C", device="cpu", writable=False)
        ],
    ) -> None: ...
    def advance(self, max_pops: int) -> bool: ...
    @property
    def inside(self) -> int | None: ...
    def counts(self) -> tuple[int, int, int, int]: ...

def primitive_intersects(
    a: Annotated[
        NDArray[numpy.float64], dict(shape=(None, None), order="C", device="cpu", writable=False)
    ],
    b: Annotated[
        NDArray[numpy.float64], dict(shape=(None, None), order="C", device="cpu", writable=False)
    ],
    velocity_a: Annotated[
        NDArray[numpy.float64], dict(shape=(None, 3), order="C", device="cpu", writable=False)
    ],
    velocity_b: Annotated[
        NDArray[numpy.float64], dict(shape=(None, 3), order="C", device="cpu", writable=False)
    ],
    duration: Annotated[
        NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)
    ],
    threads: int,
    verdicts: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order="C", device="cpu")],
) -> None: ...
def primitive_first_contacts(
    a: Annotated[
        NDArray[numpy.float64], dict(shape=(None, None), order="C", device="cpu", writable=False)
    ],
    b: Annotated[
        NDArray[numpy.float64], dict(shape=(None, None), order="C", device="cpu", writable=False)
    ],
    velocity_a: Annotated[
        NDArray[numpy.float64], dict(shape=(None, 3), order="C", device="cpu", writable=False)
    ],
    velocity_b: Annotated[
        NDArray[numpy.float64], dict(shape=(None, 3), order="C", device="cpu", writable=False)
    ],
    duration: Annotated[
        NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)
    ],
    count: int,
    threads: int,
) -> dict: ...

class DistanceQuery:
    def __init__(
        self,
        a: Tree,
        pose_a: Pose,
        b: Tree,
        pose_b: Pose,
        boxes_for_leaves: bool,
        max_depth_a: int,
        max_depth_b: int,
        tolerance: float,
    ) -> None: ...
    def advance(self, max_pops: int) -> bool: ...
    @property
    def pops(self) -> int: ...
    def answer(
        self,
    ) -> tuple[
        float,
        float,
        tuple[float, float, float],
        tuple[float, float, float],
        int,
        int,
        tuple[int, int, int, int],
    ]: ...

def swept_pairs(
    bodies: Annotated[
        NDArray[numpy.uint32], dict(shape=(None,), order="C", device="cpu", writable=False)
    ],
    times: Annotated[
        NDArray[numpy.float64], dict(shape=(None, 2), order="C", device="cpu", writable=False)
    ],
    boxes: Annotated[
        NDArray[numpy.float64], dict(shape=(None, 9), order="C", device="cpu", writable=False)
    ],
    groups: Annotated[
        NDArray[numpy.uint32], dict(shape=(None,), order="C", device="cpu", writable=False)
    ],
    is_static: Annotated[
        NDArray[numpy.uint8], dict(shape=(None,), order="C", device="cpu", writable=False)
    ],
    is_ignored: Annotated[
        NDArray[numpy.uint8], dict(shape=(None,), order="C", device="cpu", writable=False)
    ],
    group_count: int,
    reach: float,
) -> tuple[
    Annotated[NDArray[numpy.uint32], dict(shape=(None, 2), writable=False)],
    Annotated[NDArray[numpy.float64], dict(shape=(None,), writable=False)],
]: ...
