"""Logging: text for people, or JSON for machines."""

import logging
import sys

from pythonjsonlogger.json import JsonFormatter

FIELDS = "%(asctime)s %(levelname)s %(name)s %(message)s"


def install(form: str) -> None:
    """Send the log to standard error.

    Args:
        form: `json` writes an object per line with request id and times, `text` plain lines.
    """
    handler = logging.StreamHandler(sys.stderr)
    if form == "json":
        renamed = {"asctime": "time", "levelname": "level", "name": "logger"}
        handler.setFormatter(JsonFormatter(FIELDS, rename_fields=renamed))
    else:
        handler.setFormatter(logging.Formatter("%(levelname)s %(message)s"))
    root = logging.getLogger()
    root.handlers = [handler]
    root.setLevel(logging.WARNING)
    if form == "json":
        logging.getLogger("placecell").setLevel(logging.INFO)
    logging.getLogger("placecell.audit").setLevel(logging.INFO)
