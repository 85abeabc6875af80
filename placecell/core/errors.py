"""Error that every reader of drives raises."""


class DriveError(ValueError):
    """Drive cannot be read; the message names the file and what to do."""
