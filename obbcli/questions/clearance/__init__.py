"""How near two moving bodies come to each other."""
