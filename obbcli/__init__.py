"""Do two triangle meshes touch, and where? Trees of oriented boxes, exact answers, plain files.

Names are loaded when first used (PEP 562): a bare `import obbcli` imports no NumPy.
"""

from __future__ import annotations

from importlib import import_module

from obbcli.version import __version__

# That of `typing`, whose import takes longer than all else here.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from obbcli import primitives
    from obbcli.accuracy import Accuracy
    from obbcli.answers.clearance import Clearance
    from obbcli.answers.collision import Collision
    from obbcli.answers.contact import Contact, FirstContact
    from obbcli.answers.contact_piece import ContactPiece
    from obbcli.answers.counts import QueryStats
    from obbcli.answers.distance import Distance
    from obbcli.answers.free_range import FreeRange
    from obbcli.answers.overlap import Overlap
    from obbcli.answers.status import Status
    from obbcli.errors import (
        MeshError,
        MotionError,
        ObbError,
        SceneError,
        TreeFileError,
        UnresolvedError,
    )
    from obbcli.mesh import Mesh, load_mesh
    from obbcli.motion.assembly import Assembly, Part, load_parts
    from obbcli.motion.body import Body
    from obbcli.motion.motion import Motion
    from obbcli.motion.pose import Pose
    from obbcli.questions.clearance.clearance import clearance, clearance_curve
    from obbcli.questions.clearance.query import ClearanceQuery
    from obbcli.questions.collide import collide
    from obbcli.questions.contacts import contacts
    from obbcli.questions.distance import distance
    from obbcli.questions.first_contact import first_contact
    from obbcli.questions.intervals.contact_intervals import contact_intervals
    from obbcli.questions.intervals.free_range import free_range
    from obbcli.questions.notes import notes
    from obbcli.questions.overlap.overlap import overlap
    from obbcli.questions.query import Query
    from obbcli.questions.triangle_pairs import triangle_pair_blocks, triangle_pairs
    from obbcli.scene import Scene, SceneBody, SceneContact
    from obbcli.study.stability.rows import Stability
    from obbcli.study.stability.stability import stability
    from obbcli.study.tradeoff.tradeoff import tradeoff
    from obbcli.study.tradeoff.trials import Tradeoff
    from obbcli.sweeps.sweep import sweep
    from obbcli.tree.tree import ObbTree

_HOMES = {
    "Accuracy": "accuracy",
    "Assembly": "motion.assembly",
    "Body": "motion.body",
    "Clearance": "answers.clearance",
    "ClearanceQuery": "questions.clearance.query",
    "Collision": "answers.collision",
    "Contact": "answers.contact",
    "ContactPiece": "answers.contact_piece",
    "Distance": "answers.distance",
    "FirstContact": "answers.contact",
    "FreeRange": "answers.free_range",
    "Mesh": "mesh",
    "MeshError": "errors",
    "Motion": "motion.motion",
    "MotionError": "errors",
    "ObbError": "errors",
    "ObbTree": "tree.tree",
    "Overlap": "answers.overlap",
    "Part": "motion.assembly",
    "Pose": "motion.pose",
    "Query": "questions.query",
    "QueryStats": "answers.counts",
    "Scene": "scene",
    "SceneBody": "scene",
    "SceneContact": "scene",
    "SceneError": "errors",
    "Stability": "study.stability.rows",
    "Status": "answers.status",
    "Tradeoff": "study.tradeoff.trials",
    "TreeFileError": "errors",
    "UnresolvedError": "errors",
    "clearance": "questions.clearance.clearance",
    "clearance_curve": "questions.clearance.clearance",
    "collide": "questions.collide",
    "contact_intervals": "questions.intervals.contact_intervals",
    "contacts": "questions.contacts",
    "distance": "questions.distance",
    "first_contact": "questions.first_contact",
    "free_range": "questions.intervals.free_range",
    "load_mesh": "mesh",
    "load_parts": "motion.assembly",
    "notes": "questions.notes",
    "overlap": "questions.overlap.overlap",
    "stability": "study.stability.stability",
    "sweep": "sweeps.sweep",
    "tradeoff": "study.tradeoff.tradeoff",
    "triangle_pair_blocks": "questions.triangle_pairs",
    "triangle_pairs": "questions.triangle_pairs",
}

__all__ = [
    "Accuracy",
    "Assembly",
    "Body",
    "Clearance",
    "ClearanceQuery",
    "Collision",
    "Contact",
    "ContactPiece",
    "Distance",
    "FirstContact",
    "FreeRange",
    "Mesh",
    "MeshError",
    "Motion",
    "MotionError",
    "ObbError",
    "ObbTree",
    "Overlap",
    "Part",
    "Pose",
    "Query",
    "QueryStats",
    "Scene",
    "SceneBody",
    "SceneContact",
    "SceneError",
    "Stability",
    "Status",
    "Tradeoff",
    "TreeFileError",
    "UnresolvedError",
    "__version__",
    "clearance",
    "clearance_curve",
    "collide",
    "contact_intervals",
    "contacts",
    "distance",
    "first_contact",
    "free_range",
    "load_mesh",
    "load_parts",
    "notes",
    "overlap",
    "primitives",
    "stability",
    "sweep",
    "tradeoff",
    "triangle_pair_blocks",
    "triangle_pairs",
]


def __getattr__(name: str) -> object:
    """Import a public name from the module it lives in, once."""
    if name == "primitives":
        return import_module(f"{__name__}.{name}")  # which sets the name
    home = _HOMES.get(name)
    if home is None:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value: object = getattr(import_module(f"{__name__}.{home}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
