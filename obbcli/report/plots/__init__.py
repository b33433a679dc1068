"""Plots of the studies, drawn by Matplotlib."""
