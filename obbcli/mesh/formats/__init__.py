"""Readers, one a format: a file's bytes to vertices and triangles, or one clear error."""
