"""How two bodies lie to each other at rest: relation, depths, the way out."""
