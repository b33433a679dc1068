"""The words for what kernels tell by codes: how sure a contact is, and what meets what."""

from __future__ import annotations

from typing import Literal, TypeAlias, get_args

EvidenceWord: TypeAlias = Literal["intersecting", "within_tolerance", "boxes", "sampled"]
FeatureWord: TypeAlias = Literal[
    "vertex-vertex",
    "vertex-edge",
    "vertex-face",
    "edge-vertex",
    "edge-edge",
    "edge-face",
    "face-vertex",
    "face-edge",
    "face-face",
    "box",
]

EVIDENCES: tuple[EvidenceWord | None, ...] = (None, *get_args(EvidenceWord))
"""By the codes of the kernels' `Evidence`. No kernel samples: that code is of Python alone."""
FEATURES: tuple[FeatureWord | None, ...] = (None, *get_args(FeatureWord))
"""By the kernels' `FeatureCode`: the feature of A, then that of B."""
