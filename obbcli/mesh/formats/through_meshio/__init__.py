"""Formats that meshio reads, behind a guard that counts what it takes."""
