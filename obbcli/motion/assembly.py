"""`load_parts`: the parts of a mesh file, each with its path, its mesh and its place."""

from __future__ import annotations

import os
from functools import cached_property
from threading import RLock
from typing import TYPE_CHECKING

import numpy as np

from obbcli.errors import MotionError
from obbcli.files import file_and_pattern
from obbcli.mesh import Mesh
from obbcli.mesh.parts.load import read_parts
from obbcli.mesh.parts.placed import placed
from obbcli.mesh.parts.selection import selected
from obbcli.mesh.reading import mesh_of
from obbcli.motion.body import Body
from obbcli.motion.lazy_mesh import LazyMesh, used_coordinates
from obbcli.motion.pose import Pose

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterable, Iterator

    from numpy.typing import NDArray

    from obbcli.mesh.parts.load import FileParts
    from obbcli.mesh.parts.placed import PlacedPart


class Part:
    """One part of a file: a named mesh and where it stands.

    Args:
        path: the names from the root down, joined by `/`; empty where the file gives no name.
        mesh: in the part's own coordinates; other parts may share it.
        pose: from there to the file's world.
        unit: the length of 1 that the file states, such as `"m"`; None where it states none.

    Attributes:
        path: as given.
        pose: as given.
        unit: as given.
        shape: what parts of one mesh have in common; a `Body` is made of it, and then decodes the
            mesh no sooner than a question needs it.
    """

    def __init__(
        self, path: str, mesh: Mesh | LazyMesh, pose: Pose | None = None, unit: str | None = None
    ) -> None:
        self.path = path
        self.pose = Pose() if pose is None else pose
        self.unit = unit
        self.shape = mesh

    @property
    def body(self) -> Body:
        """The part at rest where the file puts it, as questions take it."""
        return Body(self.shape, self.pose)

    def posed(self, pose: Pose, *, is_absolute: bool) -> tuple[Mesh | LazyMesh, Pose]:
        """Return a shape and its pose, which together are the part moved by `pose`.

        Parts of one mesh go on to share it where `pose` moves nothing. Otherwise vertices are
        rounded where the file puts them and then by `pose`, as those of the file's mesh are.

        Args:
            pose: from the file's world to where the part is.
            is_absolute: whether other poses than this one follow, of the file's world.
        """
        if pose.is_identity and not is_absolute:
            return self.shape, self.pose
        return self._placed, pose

    @cached_property
    def _placed(self) -> Mesh | LazyMesh:
        """The part in the file's world; bodies of all poses share it."""
        return self.shape if self.pose.is_identity else LazyMesh(self._placed_mesh)

    def _placed_mesh(self) -> Mesh:
        mesh = self.mesh
        vertices = self.vertices()
        vertices.setflags(write=False)
        about = mesh.source, mesh.sha256, mesh.notes
        return Mesh(vertices, mesh.triangles, *about, unit=mesh.unit)

    @property
    def placed_mesh(self) -> Mesh:
        """The mesh in the file's world, as `load_mesh("FILE#PATTERN")` returns it.

        Raises:
            MeshError: the part is damaged, or a coordinate leaves the range of double.
        """
        placed = self._placed
        return placed.mesh if isinstance(placed, LazyMesh) else placed

    @property
    def mesh(self) -> Mesh:
        """The mesh, decoded when first asked for.

        Raises:
            MeshError: the part is damaged.
        """
        return self.shape.mesh if isinstance(self.shape, LazyMesh) else self.shape

    @property
    def is_decoded(self) -> bool:
        """Whether the mesh was read from the file's bytes."""
        return not isinstance(self.shape, LazyMesh) or self.shape.is_decoded

    def vertices(self) -> NDArray[np.float64]:
        """Return the mesh's vertices in the file's world, (V, 3), rounded as queries round them."""
        return self.pose.apply(self.mesh.vertices)

    def placed_bounds(self) -> NDArray[np.float64]:
        """Return the lower and upper corner of the part in the file's world, (2, 3)."""
        if np.array_equal(self.pose.rotation, np.eye(3)):
            # A shift rounds every coordinate alike, so that the ends stay the ends.
            return self.pose.apply(self.mesh.bounds)
        x, y, z = used_coordinates(self.shape)
        low, high = [], []
        # As `Pose.apply`, but an axis at a time, which takes a tenth of its time. The shift comes
        # last, and rounds the ends to the ends.
        for (p, q, r), shift in zip(self.pose.rotation, self.pose.translation, strict=True):
            row = p * x
            row += q * y
            row += r * z
            low.append(float(row.min() + shift))
            high.append(float(row.max() + shift))
        return np.array([low, high])

    def __repr__(self) -> str:
        return f"Part({self.path!r}, {self.pose!r}, unit={self.unit!r})"


class Assembly:
    """The parts of a file, in its order.

    Args:
        parts: the parts; no two have one path.
        source: the file's name, or None.
        sha256: SHA-256 of the file's bytes in hexadecimal, or None.
    """

    def __init__(
        self, parts: Iterable[Part], source: str | None = None, sha256: str | None = None
    ) -> None:
        self.parts = tuple(parts)
        self.source = source
        self.sha256 = sha256

    def __iter__(self) -> Iterator[Part]:
        return iter(self.parts)

    def __len__(self) -> int:
        return len(self.parts)

    def __getitem__(self, path: str) -> Part:
        """Return the part with exactly this path.

        Raises:
            KeyError: there is none.
        """
        for part in self.parts:
            if part.path == path:
                return part
        raise KeyError(path)

    def select(self, pattern: str) -> Assembly:
        """Return the parts that a pattern takes: shell wildcards over whole path elements.

        Raises:
            MeshError: it takes none; the nearest names are told.
        """
        parts = selected(self.parts, pattern, self.source or "assembly")
        return Assembly(parts, self.source, self.sha256)

    def __repr__(self) -> str:
        return f"Assembly({len(self.parts)} parts, source={self.source!r})"


def load_parts(path: str | os.PathLike[str], *, sag: float | None = None) -> Assembly:
    """Return the parts of a mesh file; what they hold is decoded when it is asked for.

    Nodes of glTF and COLLADA, objects of 3MF, `o` of OBJ (`g` where no `o` stands), solids of an
    ASCII STL, blocks of VTK's index, instances of Abaqus, superelements of Nastran, zones of
    Tecplot and SU2 are parts; any other file is one, whose path is empty. Parts that are placed
    copies of one mesh share it. A pose turns and shifts alone: what a file mirrors or scales has a
    mesh of its own, in which that is done. All parts, placed and joined, are what `load_mesh`
    returns, row for row and bit by bit.

    Args:
        path: the file, or `"FILE#PATTERN"`.
        sag: how far triangles may be from the exact surfaces of a STEP file, in the file's unit;
            None: 1e-3 of each product's size.

    Raises:
        MeshError: the file cannot be read or is refused, no part matches, or a sag is given for a
            file without exact surfaces.

    Example:
        >>> assembly = load_parts("sample_meshes/nut.obj")
        >>> [part.path for part in assembly], len(assembly.parts[0].mesh.triangles)
        (['nut'], 3896)
    """
    name, pattern = file_and_pattern(os.fspath(path))
    return assembly_of(read_parts(name, pattern, sag=sag))


def assembly_of(contents: FileParts) -> Assembly:
    """Return what a reader told of a file's parts as parts; none is decoded."""
    maker = _Maker(contents)
    made = [maker.part(part) for part in contents.parts]
    return Assembly(made, contents.source.name, contents.sha256)


class _Maker:
    """Makes parts of what a reader told; those of one shape share a mesh.

    Args:
        contents: the file.
    """

    def __init__(self, contents: FileParts) -> None:
        self._contents = contents
        self._notes = tuple(contents.source.notes)
        self._shapes: dict[Hashable, LazyMesh] = {}
        self._lock = RLock()

    def part(self, told: PlacedPart) -> Part:
        """Return a part."""
        pose, linear = _pose_and_rest(told.matrix)
        key = (told.key, None if linear is None else linear.tobytes())
        if key not in self._shapes:
            self._shapes[key] = LazyMesh(lambda: self._mesh(told, linear))
        return Part(told.path, self._shapes[key], pose, self._contents.source.unit)

    def _mesh(self, told: PlacedPart, linear: NDArray[np.float64] | None) -> Mesh:
        """Return a part's mesh, with the notes on the file and on this part."""
        source = self._contents.source
        with self._lock:
            source.notes[:] = self._notes
            source.sags.clear()
            arrays = placed(told.decode(), linear)
            if not len(arrays[1]):
                raise source.error("has no faces", "leave it out", at=f"part '{told.path}'")
            return mesh_of(arrays, source, self._contents.sha256)


def _pose_and_rest(
    matrix: NDArray[np.float64] | None,
) -> tuple[Pose, NDArray[np.float64] | None]:
    """Return a matrix as a pose after what no pose can do, (4, 4), None where a pose does it all.

    The rest is the linear part, so that nodes that differ by a shift share a mesh. Coordinates are
    rounded as by the matrix itself: sums run from the left, and the shift comes last in both.
    """
    if matrix is None:
        return Pose(), None
    try:
        return Pose(matrix[:3, :3], matrix[:3, 3]), None
    except MotionError:
        linear = np.array(matrix)
    try:
        pose = Pose(translation=matrix[:3, 3])
    except MotionError:  # not finite: the mesh is refused, with the vertex
        return Pose(), linear
    linear[:3, 3] = 0.0
    return pose, linear
