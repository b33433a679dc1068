"""Tecplot's ASCII files, zone by zone."""
