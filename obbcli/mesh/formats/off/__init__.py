"""OFF as Geomview defines it and as ModelNet writes it."""
