"""Error that every reader of drives raises."""

from placecell.core.errors import DriveError

__all__ = ["DriveError"]
