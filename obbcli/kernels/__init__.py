"""The compiled kernels; the only module that touches the extension.

Everything with a tight loop lives behind this border. Arrays that cross it were checked by
`obbcli.arrays`, and every call that can take longer than a millisecond releases the GIL.
"""

from __future__ import annotations

from obbcli.kernels._core import (
    Contact,
    ContactPlace,
    ContactQuery,
    ContainmentQuery,
    DistanceQuery,
    Evidence,
    FileTree,
    Fit,
    Limits,
    Placed,
    Pose,
    Screw,
    Split,
    StaticQuery,
    Tree,
    TreeBuilder,
    TreeError,
    ask_pairs,
    block_checksums,
    collide,
    convex_hull,
    crc32,
    crc32_by_tables,
    first_triangles_of_parts,
    keeps_denormals,
    primitive_first_contacts,
    primitive_intersects,
    sweep,
    sweep_columns,
    swept_pairs,
    triangle_pairs,
)

if not keeps_denormals():
    raise ImportError(
        "this process flushes denormal numbers to zero (a library linked with -ffast-math was "
        "loaded before), which would void the proofs of obbtree; import obbcli first, or remove it"
    )

__all__ = [
    "Contact",
    "ContactPlace",
    "ContactQuery",
    "ContainmentQuery",
    "DistanceQuery",
    "Evidence",
    "FileTree",
    "Fit",
    "Limits",
    "Placed",
    "Pose",
    "Screw",
    "Split",
    "StaticQuery",
    "Tree",
    "TreeBuilder",
    "TreeError",
    "ask_pairs",
    "block_checksums",
    "collide",
    "convex_hull",
    "crc32",
    "crc32_by_tables",
    "first_triangles_of_parts",
    "primitive_first_contacts",
    "primitive_intersects",
    "sweep",
    "sweep_columns",
    "swept_pairs",
    "triangle_pairs",
]
