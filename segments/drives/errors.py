"""The error that every reader of drives raises."""


class DriveError(ValueError):
    """A drive that cannot be read; the message names the file and what to do."""
