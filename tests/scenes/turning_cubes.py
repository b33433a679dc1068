"""`obbtree tradeoff` of a cube that turns into one beside it."""

from __future__ import annotations

import math

TURN = ("--translate-b", 0.1, 0, 0, "--omega", 0, 0, 1)
TURN_TIME = math.pi / 4 - math.acos(0.6 / math.sqrt(0.5))


def asked(obbtree, *words):
    """Run the command on cubes that turn."""
    return obbtree("tradeoff", "cube.stl", "touching.obj", *TURN, "--budget", 1000, *words)
