"""STEP: exact surfaces, cut into triangles by Open CASCADE in a process of its own."""
