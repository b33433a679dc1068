"""Stability: the same question at the extremes, and which relations its answers keep."""
