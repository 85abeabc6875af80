"""Live state: what robots reported last. It is in memory and ends with the process."""
