"""What a body is and where it goes: poses, motions, bodies, integrators of sampled motion."""
