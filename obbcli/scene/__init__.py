"""Many moving bodies: every first contact between any two of them, in order of time.

`reader` reads scenes, `swept_boxes` bounds where bodies go, `candidates` says which may meet and
not before when, and `first_contacts` refines just those, the earliest first.
"""

from __future__ import annotations

from obbcli.scene.bodies import SceneBody
from obbcli.scene.results import SceneContact
from obbcli.scene.scene import Scene

__all__ = ["Scene", "SceneBody", "SceneContact"]
