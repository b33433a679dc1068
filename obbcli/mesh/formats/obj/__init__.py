"""OBJ: statements, parts and foreign lines."""
