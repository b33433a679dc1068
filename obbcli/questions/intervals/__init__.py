"""Contact intervals: when bodies touch and when they are free, over a whole motion."""
