"""Who is measured, as benches see it: builds trees over surfaces, and asks about pairs of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from meshes.surfaces import Surface
    from numpy.typing import NDArray
    from scenes.pairs import Pair

# More contacts than any scene here has, as the peers want a limit.
MANY_CONTACTS = 10_000_000


@dataclass(frozen=True)
class Query:
    """A posed pair, ready to be asked.

    Attributes:
        collides: any contact?
        triangle_pairs: every intersecting pair, int64 (N, 2), sorted, each once.
        counts: what one yes-or-no cost in tests; the peers' Python faces do not say.
        moved: B is put where it is anew, from two arrays, and then: any contact? None where it was
            not written.
    """

    collides: Callable[[], bool]
    triangle_pairs: Callable[[], NDArray[np.int64]]
    counts: Callable[[], dict[str, object]]
    moved: Callable[[], bool] | None = None


class Contestant(Protocol):
    """A library that builds trees over surfaces and asks them."""

    name: str

    def build(self, surface: Surface) -> Any:
        """Return the whole tree of a surface."""
        ...

    def query(self, model_a: Any, model_b: Any, pair: Pair) -> Query:
        """Return the question of `pair` to two built models."""
        ...

    def nbytes(self, model: Any) -> int | None:
        """Return the memory the model says it takes, or None where it does not say."""
        ...

    def save(self, model: Any, path: Path) -> int | None:
        """Return the size of the model's file, or None where there is no such thing."""
        ...


def unique_pairs(found: Any) -> NDArray[np.int64]:
    """Return pairs sorted, each once."""
    pairs = np.array(list(found), dtype=np.int64).reshape(-1, 2)
    return np.unique(pairs, axis=0)


def arrays_of(pair: Pair) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return where B is, as two contiguous arrays of doubles."""
    return (
        np.ascontiguousarray(pair.rotation, dtype=np.float64),
        np.ascontiguousarray(pair.translation, dtype=np.float64),
    )
