"""Ours, asked when moving meshes first touch: at several accuracies, and for a mere yes or no."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from harness import OURS
from moving_sets import DURATION
from peers import Obbtree

import obbcli

if TYPE_CHECKING:
    from collections.abc import Callable

    from moving_peers import Models
    from moving_sets import Moving

# Of the size; None asks for proof, in a bracket of 1e-9 of the duration.
TOLERANCES = {OURS: None, "to 1e-3": 1e-3, "to 1e-6": 1e-6, "to 1e-9": 1e-9}
YES_NO = "yes or no"


def our_calls(models: Models, question: Moving) -> dict[str, Callable[[], Any]]:
    """Return ours at every accuracy, and the yes or no."""
    a, b = our_bodies(models, question)
    calls: dict[str, Callable[[], Any]] = {}
    for who, tolerance in TOLERANCES.items():
        size = None if tolerance is None else tolerance * question.size
        accuracy = obbcli.Accuracy(distance_tolerance=size)
        calls[who] = lambda accuracy=accuracy: obbcli.first_contact(a, b, DURATION, accuracy)
    calls[YES_NO] = lambda: obbcli.collide(a, b, DURATION)
    return calls


def our_bodies(models: Models, question: Moving) -> tuple[Any, Any]:
    """Return the bodies as ours takes them, the trees whole."""
    bodies = []
    for surface, path in ((question.a, question.path_a), (question.b, question.path_b)):
        tree = models.get(OURS, surface, Obbtree().build)
        motion = obbcli.Motion(path.velocity, path.spin, path.center)
        bodies.append(obbcli.Body(tree, obbcli.Pose(path.rotation, path.center), motion))
    return bodies[0], bodies[1]
