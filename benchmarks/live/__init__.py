"""Live: a robot that drives through a town, and an agent that is disturbed."""
