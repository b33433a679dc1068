"""Gmsh files of versions 2 and 4."""
