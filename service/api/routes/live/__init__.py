"""Routes about the present: robots and events."""
