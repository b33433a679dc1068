"""A scene file of unit cubes, of which one hits another at t = 2."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

SCENE = """
duration = 4
[[body]]
name = "still"
mesh = "cube.stl"
static = true
[[body]]
name = "slow"
mesh = "cube.stl"
pose = { translation = [3, 0, 0] }
motion = { linear_velocity = [-1, 0, 0] }
[[body]]
name = "far, far"
mesh = "far.stl"
pose = { translation = [0, 50, 0] }
"""


def add(scene: Path, text: str) -> None:
    """Add to the scene."""
    (scene / "cell.toml").write_text(SCENE + text)
