"""Map out: keyframes, edits of the robot's own map, and their way to the service."""
