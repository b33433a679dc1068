"""Trees of oriented boxes: built whole or on demand, saved, opened, checked."""
