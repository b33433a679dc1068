"""Cases with known truth, kept in data/cases; what each field means is in the README beside them.

One function a file, read once; do not write to what they return.
"""

from __future__ import annotations

import gzip
import json
from functools import cache
from pathlib import Path
from typing import Any

from oracles.exact import Box

FOLDER = Path(__file__).resolve().parents[1] / "data" / "cases"


def _read(name: str) -> Any:
    return json.loads(gzip.decompress((FOLDER / f"{name}.json.gz").read_bytes()))


@cache
def tri_tri_static() -> list[dict[str, Any]]:
    """Return triangles `A`, `B` with `intersect`, `contact` and, apart, `distance`."""
    return list(_read("tri_tri_static")["cases"])


@cache
def obb_pairs() -> list[dict[str, Any]]:
    """Return boxes `A`, `B` (see `box`) with `intersect`, `touch` and `separation`."""
    return list(_read("obb_pairs")["cases"])


@cache
def tri_obb() -> list[dict[str, Any]]:
    """Return triangles `tri` with `V_tri`, a `box` with its `V`: `hit`, `t`, `intersect_t0`."""
    return list(_read("tri_obb")["cases"])


@cache
def obb_linear_ccd() -> list[dict[str, Any]]:
    """Return boxes `A`, `B`, each with its velocity `V`, over [0, `T`]: `hit`, `t`."""
    return list(_read("obb_linear_ccd")["cases"])


@cache
def tri_tri_linear_ccd() -> list[dict[str, Any]]:
    """Return triangles `A`, `B` with `VA`, `VB` over [0, `T`]: `hit`, `t_exact`, `t_last`."""
    return list(_read("tri_tri_linear_ccd")["cases"])


@cache
def third_party_static() -> list[dict[str, Any]]:
    """Return meshes `a`, `b` from other projects' reports with `exact_contact_pairs`."""
    return list(_read("third_party_static"))


@cache
def third_party_ccd() -> list[dict[str, Any]]:
    """Return `body_a`, `body_b` from other projects' reports: `expected_hit`, `expected_toi`."""
    return list(_read("third_party_ccd")["cases"])


@cache
def rigid_translation_subset() -> list[dict[str, Any]]:
    """Return vertex-face and edge-edge queries of a public benchmark: `toi_rational`."""
    return list(_read("rigid_translation_subset"))


@cache
def rigid_ccd() -> list[dict[str, Any]]:
    """Return moving bodies `A`, `B` of named meshes (`rigid_meshes`) with a bracket in `truth`."""
    return list(_read("rigid_ccd")["cases"])


@cache
def rigid_meshes() -> dict[str, dict[str, Any]]:
    """Return the meshes that `rigid_ccd` names: `vertices`, `faces`."""
    return dict(_read("rigid_ccd")["meshes"])


def box(record: dict[str, Any]) -> Box:
    """Return a case's box; the files call half lengths `extents`."""
    return Box(record["center"], record["axes"], record["extents"])
