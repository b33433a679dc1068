"""Tradeoff: speed against accuracy, measured, every claim held against a proof."""
