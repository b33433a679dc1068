"""COLLADA 1.4 and 1.5, with its scene, units and axes."""
