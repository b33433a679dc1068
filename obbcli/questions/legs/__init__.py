"""Questions about motion in legs: times in which both bodies have constant velocities."""
