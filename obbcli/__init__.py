"""Do two triangle meshes touch, and where? Trees of oriented boxes, exact answers, plain files.

Names are loaded when first used (PEP 562): a bare `import obbcli` imports no NumPy.
"""

from __future__ import annotations

from importlib import import_module

# That of `typing`, whose import takes longer than all else here.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from obbcli import primitives
    from obbcli.accuracy import Accuracy
    from obbcli.blocks import triangle_pair_blocks
    from obbcli.body import Body
    from obbcli.contact import Query, first_contact
    from obbcli.errors import (
        MeshError,
        MotionError,
        ObbError,
        SceneError,
        TreeFileError,
        UnresolvedError,
    )
    from obbcli.mesh import Mesh, load_mesh
    from obbcli.motion import Motion, Pose
    from obbcli.nearest import distance
    from obbcli.pairs import contacts
    from obbcli.query import collide, triangle_pairs
    from obbcli.results import Collision, Contact, Distance, FirstContact, QueryStats, Status
    from obbcli.scene import Scene, SceneBody, SceneContact
    from obbcli.study import Stability, Tradeoff, stability, tradeoff
    from obbcli.sweeps import sweep
    from obbcli.tree import ObbTree

# A literal, because asking the installed metadata costs three times a bare interpreter's start.
__version__ = "0.1.0"

_HOMES = {
    "Accuracy": "accuracy",
    "Body": "body",
    "Collision": "verdict",
    "Contact": "results",
    "Distance": "results",
    "FirstContact": "results",
    "Mesh": "mesh",
    "MeshError": "errors",
    "Motion": "motion",
    "MotionError": "errors",
    "ObbError": "errors",
    "ObbTree": "tree",
    "Pose": "motion",
    "Query": "contact",
    "QueryStats": "verdict",
    "Scene": "scene",
    "SceneBody": "scene",
    "SceneContact": "scene",
    "SceneError": "errors",
    "Stability": "study",
    "Status": "verdict",
    "Tradeoff": "study",
    "TreeFileError": "errors",
    "UnresolvedError": "errors",
    "collide": "query",
    "contacts": "pairs",
    "distance": "nearest",
    "first_contact": "contact",
    "load_mesh": "mesh",
    "stability": "study",
    "sweep": "sweeps",
    "tradeoff": "study",
    "triangle_pair_blocks": "blocks",
    "triangle_pairs": "query",
}

__all__ = [
    "Accuracy",
    "Body",
    "Collision",
    "Contact",
    "Distance",
    "FirstContact",
    "Mesh",
    "MeshError",
    "Motion",
    "MotionError",
    "ObbError",
    "ObbTree",
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
    "collide",
    "contacts",
    "distance",
    "first_contact",
    "load_mesh",
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
