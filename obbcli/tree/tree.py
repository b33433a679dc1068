"""`ObbTree`: a mesh under oriented boxes, built, saved, opened and proven. Eberly 2008 §6."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from obbcli.errors import TreeFileError
from obbcli.mesh import Mesh, load_mesh
from obbcli.tree import file as treefile
from obbcli.tree import header as treeheader
from obbcli.tree.facts import TreeFacts
from obbcli.tree.growing import Growth
from obbcli.tree.options import DEFAULT_BUILD, BuildOptions, kernel_limits
from obbcli.tree.whole import WholeTree, kernel_of

if TYPE_CHECKING:
    import os
    from collections.abc import Callable

    from obbcli.motion.assembly import Part
    from obbcli.tree.options import Fit, Split


class ObbTree(TreeFacts):
    """A tree of oriented boxes over the triangles of a mesh.

    Made by `build` or `open`. Safe to share between threads, and the same for every question: that
    nodes may be made as questions reach them changes no answer.
    """

    @classmethod
    def build(
        cls,
        mesh_or_path: Mesh | Part | str | os.PathLike[str],
        fit: Fit = DEFAULT_BUILD.fit,
        split: Split = DEFAULT_BUILD.split,
        leaf_size: int = DEFAULT_BUILD.leaf_size,
        max_depth: int | None = DEFAULT_BUILD.max_depth,
        lazy: bool = True,
        *,
        max_memory: int | None = None,
        progress: Callable[[float], object] | None = None,
    ) -> ObbTree:
        """Return a tree over a mesh.

        Iterative, whatever the shape of the tree; the same mesh and options give the same bytes on
        every machine. Between slices of the work other threads and signals get their turn.

        Args:
            mesh_or_path: the mesh, a `Part` where its file puts it, or the file to load it from.
            fit: orients a box by the spread of its triangles' area (`"triangles"`, §6.1.3 with its
                weights mended), of their corners (`"points"`, §6.1.2), of their convex hull's area
                (`"hull"`), for the least volume (`"min-volume"`, §6.1.1: nearly; slow to build), or
                not at all (`"axis-aligned"`).
            split: parts a node across its longest axis at the median of the triangles' centroids
                (`"median"`), or at the box's center, trying the next longest axes and at last the
                median (`"center"`, §6.2); or across any axis where the parts' squared diagonals
                times their counts are least (`"compact"`).
            leaf_size: a node of so many triangles is not split.
            max_depth: nodes this deep are not split; the root's depth is 0. None: no limit.
            lazy: whether nodes wait until a question first reaches them. The tree and the answers
                are the same either way.
            max_memory: bytes that the build may need at its peak. None: no limit.
            progress: called now and then with the share done, from 0 to 1; only where `lazy` is
                false.

        Raises:
            MeshError: the mesh cannot be read or is refused, an option is none of the above, or the
                build would need more than `max_memory`.
            OSError: the file cannot be read.

        Example:
            >>> tree = ObbTree.build("sample_meshes/nut.obj")
            >>> tree.triangle_count, tree.levels[0].box_count
            (3896, 1)
        """
        mesh = mesh_or_path
        if not isinstance(mesh, Mesh):
            # A `Part` stands where its file puts it, as the path `"FILE#PATTERN"` would take it.
            placed = getattr(mesh, "placed_mesh", None)
            # Only a part is no path.
            mesh = placed if isinstance(placed, Mesh) else load_mesh(mesh)  # type: ignore[arg-type]
        options = BuildOptions(fit, split, leaf_size, max_depth)
        growth = Growth(mesh, options, max_memory, on_demand=lazy)
        return cls(growth if lazy else WholeTree(growth.arrays(progress)))

    def with_root(self) -> ObbTree:
        """Return this tree over a mesh, its root box made: no question can do without it."""
        self.kernel.boxes_of_level(0)
        return self

    @classmethod
    def open(cls, path: str | os.PathLike[str], verify: bool = True) -> ObbTree:
        """Return the tree in a file, of which questions read what they reach.

        The file stays open. One that is replaced, as `save` does it, goes on answering as it was;
        one that is overwritten or cut short is refused where a question reaches what is gone.

        Args:
            path: a tree file (`.obbt`).
            verify: whether data are compared with their checksums when they are first read. Links
                are checked all the same.

        Raises:
            TreeFileError: no tree file, another version, truncated or damaged where it was read.
            OSError: the file cannot be read.
        """
        from obbcli.tree.opened import OpenedTree

        return cls(OpenedTree(path, verify=verify), Path(path))

    @classmethod
    def from_bytes(
        cls, data: bytes | bytearray | memoryview, name: str = "bytes", verify: bool = True
    ) -> ObbTree:
        """Return the tree in the bytes of a tree file; `name` is the place named in errors.

        The bytes are copied: what their owner does to them later changes no answer.

        Raises:
            TreeFileError: as `open`.
        """
        return cls(WholeTree(treefile.parse_tree(data, name, verify=verify)))

    def save(self, path: str | os.PathLike[str]) -> int:
        """Write the tree to a file, whole or not at all, and return the file's size in bytes.

        Nodes that no question has reached yet are made or read first.

        Raises:
            TreeFileError: the tree was opened from a file that is damaged.
            OSError: the place cannot be written to.
        """
        surface = self._surface or treeheader.Surface.of(self.mesh)
        return treefile.write_tree(path, self._arrays, surface)

    def to_bytes(self) -> bytes:
        """Return the bytes of the tree's file, as `save` would write it.

        Raises:
            TreeFileError: the tree was opened from a file that is damaged.
        """
        surface = self._surface or treeheader.Surface.of(self.mesh)
        return b"".join(treefile.tree_bytes(self._arrays, surface))

    def check(self) -> None:
        """Prove the tree: checksums, structure, and every triangle inside all boxes above it.

        Nodes that no question has reached yet are made first. O(n depth). Containment is proven
        with the rounding of the proof counted against the box.

        Raises:
            TreeFileError: it is not what it claims to be; the message names the first fault.
            OSError: the file that the tree was opened from can no longer be read.
        """
        if self._path is not None:
            from obbcli.tree.opened import OpenedTree

            OpenedTree(self._path).arrays()
        limits = kernel_limits(self.leaf_size, self.max_depth)
        fault = kernel_of(self._arrays, self.place).check(*limits)
        if fault is None and self._surface not in (None, treeheader.Surface.of(self.mesh)):
            fault = "the surface has other bounds or another centroid than the header says"
        if fault is not None:
            raise TreeFileError(self.place, fault, "build it again from the mesh")

    def __repr__(self) -> str:
        return f"ObbTree({self.triangle_count} triangles, {self.node_count} boxes)"


def load_tree(path: str | os.PathLike[str], *, verify: bool = True) -> ObbTree:
    """Return the tree in a tree file, or one built with default options over a mesh file.

    Tree files are told by their first bytes, whatever their name.

    Raises:
        MeshError: the mesh cannot be read or is refused.
        TreeFileError: the tree file is damaged.
        OSError: the file cannot be read.
    """
    if begins_as_tree(Path(path)):
        tree = ObbTree.open(path, verify=verify)
        check_measures(path, tree.unit)
        return tree
    # No answer shows the tree of a single question, so its mesh is not hashed.
    return ObbTree.build(load_mesh(path, hashed=False))


def check_measures(path: object, unit: str | None) -> None:
    """Refuse a tree file whose path says that it is scaled, as scenes write them.

    Args:
        path: of the file, a `MeasuredFile` where it says so.
        unit: that the tree is in.

    Raises:
        MeshError: its boxes do not allow it.
    """
    check = getattr(path, "check_tree", None)
    if check is not None:
        check(unit)


def begins_as_tree(path: Path) -> bool:
    """Return whether a file claims to be a tree file; faults are left to its reader."""
    if path.suffix.lower() == ".obbt":
        return True
    try:
        with path.open("rb") as file:
            return treeheader.is_tree_file(file.read(len(treeheader.MAGIC)))
    except OSError:
        return False
