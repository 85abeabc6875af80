"""Training of the head that tells a segment's class."""
