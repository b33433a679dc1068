"""`Scene`: many moving bodies, and every first contact between two of them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from obbcli.accuracy import CLEARANCE_TOLERANCE, DEPTH_TOLERANCE, Accuracy
from obbcli.errors import SceneError
from obbcli.files import file_of
from obbcli.mesh import known_suffixes
from obbcli.mesh.formats import suffix_of
from obbcli.motion.assembly import load_parts
from obbcli.questions.border import whole_limit
from obbcli.questions.pair_question import duration_of
from obbcli.scene.bodies import SceneParts, as_bodies, as_ignored
from obbcli.scene.first_contacts import FirstContacts
from obbcli.scene.pairs import ScenePairs
from obbcli.scene.shapes import Shapes
from obbcli.threads import thread_count

if TYPE_CHECKING:
    import os
    from collections.abc import Iterable, Sequence

    from obbcli.scene.all_contacts import AllContacts
    from obbcli.scene.bodies import Bodies, Ignore, SceneBody
    from obbcli.scene.clearances import Clearances
    from obbcli.scene.overlaps import Overlaps


class Scene:
    """Many moving bodies.

    What is answered about a pair is what `first_contact` answers with the scene's duration and
    accuracy, bit for bit. What is not asked for is not done: files are read when a question first
    needs them, each once, however many bodies are made of it; a tree file no further than questions
    reach; pairs that keep apart cost no look at their trees.

    Args:
        bodies: a mapping of names to bodies, trees, meshes, parts or paths; or `SceneBody` objects;
            or an `Assembly`, each part of which is a body at rest that is called by its path.
        ignore: pairs not asked about: `{"bodies": [a, b]}`, `{"groups": [g]}` for all of one group
            among themselves, `{"groups": [g, h]}` for those of one against those of the other.
        duration: s; the closed interval [0, duration] is asked about. None: the last time of all
            motions through poses, else 1 where anything moves, else 0.
        accuracy: what is asked of each answer. `max_iterations` holds for a pair, `timeout` for all
            together. None: the defaults.
        solid: whether a body inside another at t = 0 is contact too, where a question does not say.
        verify: whether the checksums of tree files are compared.

    Attributes:
        bodies: the bodies, in order.
        ignore: the pairs that are not asked about, checked.
        duration: s.
        accuracy: as used.
        solid: as given.

    Raises:
        SceneError: no bodies, two of one name, or `ignore` names what is not there.
        MotionError: the duration is negative or not finite, or a body is none.

    Example:
        >>> for found in Scene.load("sample_meshes/cell.toml").first_contacts():
        ...     print(found.body_a, found.body_b, found.time)
        gear pinion 0.05679926619329175
        bolt nut 0.18555021222034207
        left finger workpiece 0.5
        right finger workpiece 0.5
    """

    def __init__(
        self,
        bodies: Bodies,
        ignore: Iterable[Ignore] = (),
        duration: float | None = None,
        accuracy: Accuracy | None = None,
        *,
        solid: bool = False,
        verify: bool = True,
    ) -> None:
        self.bodies: tuple[SceneBody, ...] = as_bodies(bodies)
        self.ignore = as_ignored(ignore, self.bodies)
        self.duration = duration_of(duration, [body.body for body in self.bodies])
        self.accuracy = Accuracy() if accuracy is None else accuracy
        if not isinstance(self.accuracy, Accuracy):
            raise SceneError("accuracy", f"is {accuracy!r}", "pass an Accuracy")
        if not isinstance(solid, bool):
            raise SceneError("solid", f"is {solid!r}", "use True or False")
        self.solid = solid
        self._parts = SceneParts(self.bodies, self.ignore, self.duration, self.accuracy, solid)
        self._shapes = Shapes(verify=verify)

    @classmethod
    def load(cls, path: str | os.PathLike[str], *, verify: bool = True) -> Scene:
        """Return the scene in a TOML or JSON file; the meshes are read when they are needed.

        Of a mesh file, told by its suffix, the scene is all its parts at rest, as of an `Assembly`.

        Args:
            path: the file, or a mesh file or `"FILE#PATTERN"`. One whose name ends in `.json` is
                JSON, else one that begins with `{`, and TOML all others.
            verify: whether the checksums of tree files are compared.

        Raises:
            SceneError: it cannot be read or is refused; the message names line or key.
        """
        from obbcli.scene.reader import read_scene

        if is_mesh_file(path):
            return cls(load_parts(path), verify=verify)
        parts = read_scene(path)
        bodies, ignore, duration, accuracy, solid = parts
        return cls(bodies, ignore, duration, accuracy, solid=solid, verify=verify)

    def first_contacts(
        self,
        first: bool = False,
        pairs: Iterable[tuple[str, str]] | None = None,
        solid: bool | None = None,
        threads: int | None = None,
    ) -> FirstContacts:
        """Return the first contact of every pair that touches, in order of time.

        Of equal times the order of the bodies decides. Pairs that are not there are proven apart;
        those that a limit leaves open come as `unresolved`, at the time up to which that is proven.

        Args:
            first: whether to end after the earliest contact; no question is then refined further
                than that.
            pairs: the pairs asked about, by the names of their bodies; only their files are read.
                None: all.
            solid: whether a body inside another at t = 0 is contact too, without touching, as of
                `first_contact`. Bodies that may be inside another or hold one have to be
                watertight; of those whose boxes are apart at t = 0 that is not asked. None: as the
                scene says.
            threads: how many look at pairs at the same time, where all contacts are asked for.
                Answers and their order do not depend on it. None: one a core that may be used.

        Returns:
            an iterator of `SceneContact` that also has `stats`.

        Raises:
            ObbError: `threads` is no positive integer.
            SceneError: a pair is none, or names what is not there, or what the scene ignores.
            MeshError: a mesh cannot be read or is refused, as one that is not watertight if
                `solid`.
            TreeFileError: a tree file is damaged.
            OSError: a file cannot be read.
        """
        asks_solids = self.solid if solid is None else solid
        asked = ScenePairs(self._parts, self._shapes, pairs, solid=asks_solids)
        return FirstContacts(asked, first=first, threads=thread_count(threads))

    def contacts(
        self,
        limit: int | None = None,
        pairs: Iterable[tuple[str, str]] | None = None,
        solid: bool | None = None,
    ) -> AllContacts:
        """Return the first contact of every pair of triangles that touches, in order of time.

        As `obbcli.contacts` gives them for two bodies; each two are turned to only when their
        contacts may be next. Where a limit ends the list of two, `unresolved` stands in their
        stead, at the time up to which it is whole.

        Args:
            limit: at most so many contacts. None: all.
            pairs: as of `first_contacts`.
            solid: False lists the triangles of a scene of solids too; True is refused, as a body
                inside another has none that touch. None: as the scene says.

        Returns:
            an iterator of `SceneContact` that also has `stats`.

        Raises:
            MotionError: `limit` is no whole number of at least 1, or the sampled method is asked
                for, which knows the first contact alone.
            SceneError: solids are asked about; and as `first_contacts`.
            MeshError, TreeFileError, OSError: as `first_contacts`.
        """
        from obbcli.scene.all_contacts import AllContacts

        if self.solid if solid is None else solid:
            fault = "asks about solids, and a body inside another has no triangles that touch"
            raise SceneError("solid", fault, "ask for first_contacts, or with solid=False")
        most = None if limit is None else whole_limit(limit)
        return AllContacts(ScenePairs(self._parts, self._shapes, pairs), most)

    def overlaps(
        self,
        pairs: Iterable[tuple[str, str]] | None = None,
        *,
        tolerance: float = DEPTH_TOLERANCE,
        touch: Sequence[float] | None = None,
    ) -> Overlaps:
        """Return how the bodies lie to each other at t = 0: all pairs that are not clear, in order.

        Each is what `overlap` answers, with the scene's `clearance`, `max_iterations` and, for all
        pairs together, `timeout`; but the depths of bodies that touch are no closer than that they
        touch. Closed meshes are solids, others surfaces.

        Args:
            pairs: as of `first_contacts`.
            tolerance: as of `overlap`.
            touch: likewise.

        Returns:
            an iterator of `SceneOverlap` that also has `stats`.

        Raises:
            MotionError: `tolerance` or `touch` is refused.
            SceneError, MeshError, TreeFileError, OSError: as `first_contacts`.
        """
        from obbcli.questions.overlap.asked import Asked
        from obbcli.scene.overlaps import Overlaps

        asked = Asked.of(tolerance, touch=touch)._replace(values="deep")
        return Overlaps(self._parts, self._shapes, pairs, asked)

    def clearances(
        self,
        within: float | None = None,
        at_least: float | None = None,
        pairs: Iterable[tuple[str, str]] | None = None,
        solid: bool | None = None,
        *,
        tolerance: float = CLEARANCE_TOLERANCE,
    ) -> Clearances:
        """Return how near the bodies come to each other in [0, duration], the nearest pair first.

        Each is what `clearance` answers of the two, as a proven bracket; pairs are in the order of
        its lower end, and searched no further than that needs: who takes the first pair alone has
        the scene's least distance, and trees of bodies further apart are not looked at.

        Args:
            within: mesh units; pairs that are proven further apart are counted in `stats`, and left
                out. None: all pairs come.
            at_least: mesh units; ask only whether each two keep this distance: the search for a
                pair ends as soon as that is known. Pairs whose bounds prove it are left out.
            pairs: as of `first_contacts`.
            solid: likewise.
            tolerance: as of `clearance`.

        Returns:
            an iterator of `SceneClearance` that also has `stats`, and in `low` what is proven of
            all pairs still to come.

        Raises:
            MotionError: an argument is refused, or the scene's accuracy says more than
                `max_iterations` and `timeout`, as of `clearance`.
            SceneError, MeshError, TreeFileError, OSError: as `first_contacts`.
        """
        from obbcli.questions.checked import number_of
        from obbcli.questions.clearance.asked import Asked, refuse_other_accuracy
        from obbcli.scene.clearances import Clearances

        asked = Asked.of(tolerance, at_least, self.solid if solid is None else solid)
        reach = None if within is None else number_of("within", within)
        refuse_other_accuracy(self.accuracy)
        return Clearances(self._parts, self._shapes, pairs, asked, reach)

    def __repr__(self) -> str:
        return f"Scene({len(self.bodies)} bodies, {self.duration!r} s)"


def is_mesh_file(path: str | os.PathLike[str]) -> bool:
    """Return whether a name is that of a mesh file, which is a scene of its parts."""
    return suffix_of(file_of(path)) in known_suffixes()
