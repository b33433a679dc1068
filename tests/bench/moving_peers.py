"""Those who are asked when moving meshes first touch, behind one face.

What python-fcl has for it; what its users write themselves; and the Tight-Inclusion method of
ipctk, for translation. Models, poses and requests are made beforehand.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from moving_sets import DURATION, Moving
from peers import Fcl

if TYPE_CHECKING:
    from collections.abc import Callable

    from meshes.surfaces import Surface

LOOP_STEPS = 100
# Of the size: where the advancement on distances stops, and gives up after so many distances.
ADVANCE_TOLERANCE = 1e-6
ADVANCE_STEPS = 2_000
TIGHT_TRIANGLES = 600
TIGHT_TOLERANCE = 1e-6
TIGHT_ITERATIONS = 1_000_000
LOOP = f"fcl.collide x {LOOP_STEPS}"
ADVANCEMENT = "advancement on fcl.distance"


@dataclass(frozen=True)
class Answer:
    """What a peer says: contact or not, and when; `hit` is None where it refuses to say."""

    hit: bool | None
    time: float | None = None


class MovingPeer(Protocol):
    """Someone who can be asked about moving meshes."""

    name: str
    # s: asked once a question, and no more in a class after that long; None: always, in turns.
    patience: float | None

    def can_ask(self, question: Moving) -> bool:
        """Return whether the question can be put to it."""
        ...

    def call(self, models: Models, question: Moving) -> Callable[[], Answer]:
        """Return the question made ready, to be asked once."""
        ...


class Models:
    """Everybody's models of surfaces, each built once."""

    def __init__(self) -> None:
        self._built: dict[tuple[str, int], Any] = {}

    def get(self, who: str, surface: Surface, build: Callable[[Surface], Any]) -> Any:
        """Return a model, built when first asked for."""
        key = (who, id(surface))
        if key not in self._built:
            self._built[key] = build(surface)
        return self._built[key]


def fcl_model(surface: Surface) -> Any:
    """Return a `fcl.BVHModel`."""
    return Fcl().build(surface)


class FclSolver:
    """`fcl.continuousCollide` by one of its solvers, on one of its kinds of path.

    Pure translation takes the kind of that name. Where bodies turn, "linear" is to be our path, and
    "screw" is another one between the same two poses.
    """

    def __init__(self, solver: str, path: str, samples: int, patience: float | None) -> None:
        self.name = f"fcl {solver}{'' if path == 'trans' else f', {path}'}"
        self.patience = patience
        self._solver, self._path, self._samples = solver, path, samples

    def can_ask(self, question: Moving) -> bool:
        """Return whether the kind of path is that of the question."""
        return (question.motion == "translation") == (self._path == "trans")

    def call(self, models: Models, question: Moving) -> Callable[[], Answer]:
        """Return the question; the polynomial solver changes its models and gets new ones."""
        import fcl
        from fcl import CCDMotionType, CCDSolverType

        solver = {
            "advancement": CCDSolverType.CCDC_CONSERVATIVE_ADVANCEMENT,
            "samples": CCDSolverType.CCDC_NAIVE,
            "ray shooting": CCDSolverType.CCDC_RAY_SHOOTING,
            "polynomial": CCDSolverType.CCDC_POLYNOMIAL_SOLVER,
        }[self._solver.rstrip(" 0123456789")]
        request = fcl.ContinuousCollisionRequest(
            num_max_iterations=self._samples,
            toc_err=1e-9,
            ccd_motion_type=getattr(CCDMotionType, f"CCDM_{self._path.upper()}"),
            ccd_solver_type=solver,
        )
        changes = solver == CCDSolverType.CCDC_POLYNOMIAL_SOLVER
        arguments = []
        for surface, path in ((question.a, question.path_a), (question.b, question.path_b)):
            model = fcl_model(surface) if changes else models.get("fcl", surface, fcl_model)
            body = fcl.CollisionObject(model, fcl.Transform(*path.at(0.0)))
            arguments += [body, fcl.Transform(*path.at(DURATION))]

        def ask() -> Answer:
            result = fcl.ContinuousCollisionResult()
            said = fcl.continuousCollide(*arguments, request, result)
            if said < 0:
                return Answer(None)
            return Answer(result.is_collide, result.time_of_contact if result.is_collide else None)

        return ask


class Loop:
    """`fcl.collide` at evenly spaced times, the ends included, until it says yes."""

    name = LOOP
    patience = None

    def can_ask(self, question: Moving) -> bool:  # noqa: ARG002
        """Return True."""
        return True

    def call(self, models: Models, question: Moving) -> Callable[[], Answer]:
        """Return the question; poses of B as A sees it are made beforehand."""
        import fcl

        a, b = _resting(models, question)
        times = [float(t) for t in np.linspace(0, DURATION, LOOP_STEPS + 1)]
        poses = [question.relative(t) for t in times]
        request = fcl.CollisionRequest(num_max_contacts=1, enable_contact=False)

        def ask() -> Answer:
            for t, pose in zip(times, poses, strict=True):
                b.setTransform(fcl.Transform(*pose))
                if fcl.collide(a, b, request, fcl.CollisionResult()):
                    return Answer(True, t)
            return Answer(False)

        return ask


class Advancement:
    """Conservative advancement on `fcl.distance`: step by the distance over the closing speed."""

    name = ADVANCEMENT
    patience = 4.0

    def can_ask(self, question: Moving) -> bool:  # noqa: ARG002
        """Return True."""
        return True

    def call(self, models: Models, question: Moving) -> Callable[[], Answer]:
        """Return the question."""
        distance_at = fcl_distance(models, question)
        speed, enough = question.closing_speed, ADVANCE_TOLERANCE * question.size

        def ask() -> Answer:
            t = 0.0
            for _ in range(ADVANCE_STEPS):
                gap = distance_at(t)
                if gap <= enough:
                    return Answer(True, t)
                t += gap / speed
                if t > DURATION:
                    return Answer(False)
            return Answer(None)

        return ask


def fcl_distance(models: Models, question: Moving) -> Callable[[float], float]:
    """Return python-fcl's distance of the surfaces as a function of time."""
    import fcl

    a, b = _resting(models, question)
    request = fcl.DistanceRequest()

    def distance(t: float) -> float:
        b.setTransform(fcl.Transform(*question.relative(t)))
        return max(0.0, float(fcl.distance(a, b, request, fcl.DistanceResult())))

    return distance


def fcl_collides(models: Models, question: Moving) -> Callable[[float], bool]:
    """Return whether python-fcl finds contact, as a function of time."""
    import fcl

    a, b = _resting(models, question)
    request = fcl.CollisionRequest(num_max_contacts=1, enable_contact=False)

    def collides(t: float) -> bool:
        b.setTransform(fcl.Transform(*question.relative(t)))
        return bool(fcl.collide(a, b, request, fcl.CollisionResult()))

    return collides


def _resting(models: Models, question: Moving) -> list[Any]:
    """Return python-fcl's bodies, A as it is for itself."""
    import fcl

    return [
        fcl.CollisionObject(models.get("fcl", surface, fcl_model), fcl.Transform())
        for surface in (question.a, question.b)
    ]


class TightInclusion:
    """ipctk: the largest step free of contact by Tight-Inclusion, without its default rescaling."""

    name = "ipctk Tight-Inclusion"
    patience = 10.0

    def can_ask(self, question: Moving) -> bool:
        """Return whether vertices move straight, and are few."""
        count = max(len(question.a.faces), len(question.b.faces))
        return question.motion == "translation" and count <= TIGHT_TRIANGLES

    def call(self, models: Models, question: Moving) -> Callable[[], Answer]:  # noqa: ARG002
        """Return the question about both meshes as one, whose parts may meet."""
        import ipctk

        a, b = question.a, question.b
        faces = np.asfortranarray(np.concatenate([a.faces, b.faces + len(a.vertices)]), np.int32)
        ends = [
            np.asfortranarray(
                np.concatenate(
                    [
                        surface.vertices @ turn.T + place
                        for surface, (turn, place) in (
                            (a, question.path_a.at(t)),
                            (b, question.path_b.at(t)),
                        )
                    ]
                )
            )
            for t in (0.0, DURATION)
        ]
        mesh = ipctk.CollisionMesh(ends[0], ipctk.edges(faces), faces)
        patches = np.repeat(np.arange(2, dtype=np.int32), [len(a.vertices), len(b.vertices)])
        mesh.can_collide = ipctk.make_vertex_patches_filter(patches)
        method = ipctk.TightInclusionCCD(TIGHT_TOLERANCE, TIGHT_ITERATIONS, 1.0)

        def ask() -> Answer:
            step = ipctk.compute_collision_free_stepsize(mesh, *ends, 0.0, ipctk.LBVH(), method)
            return Answer(step < 1.0, step * DURATION if step < 1.0 else None)

        return ask


PEERS: tuple[MovingPeer, ...] = (
    Loop(),
    Advancement(),
    *(
        FclSolver(solver, path, samples, patience)
        for path in ("trans", "linear", "screw")
        for solver, samples, patience in (
            ("advancement", 10, 1.0),
            ("samples 10", 10, None),
            (f"samples {LOOP_STEPS}", LOOP_STEPS, None),
            ("polynomial", 10, 1.0),
            ("ray shooting", 10, 1.0),
        )
    ),
    TightInclusion(),
)
