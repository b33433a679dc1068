"""Nastran and OptiStruct bulk data."""
