"""Service: place recognition and shared maps for robot teams, over HTTP or in one process."""
