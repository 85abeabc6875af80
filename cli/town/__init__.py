"""`placecell town`."""

from cli.town.command import town

__all__ = ["town"]
