"""Errors of PostgreSQL as errors of the store."""

from collections.abc import Sequence

import psycopg
from psycopg import errors

from service.maps.store import StoreError, Trouble

_KINDS: Sequence[tuple[tuple[str, ...], Trouble, str]] = (
    (("53100",), "full", "the disk of the database is full"),
    (("25006",), "read-only", "the database is read-only, as a standby is"),
    (("55P03", "57014", "40001", "40P01"), "busy", "another service holds the map's row"),
    (("XX001", "XX002"), "damaged", "the database is damaged"),
    (("42P01", "3F000"), "moved", "a table was removed while the service ran"),
    (
        ("42501",),
        "failing",
        "the user of the database lacks a right. Use the owner of its schema placecell, or a user "
        "that may create it",
    ),
    (("08", "57P", "53300", "25P03"), "unreachable", "the database cannot be reached"),
)
"""Beginnings of SQLSTATE codes, the kind of the error, and its meaning."""


NOT_CONNECTED = ("connection failed", "failed to resolve", "connection timeout")
"""Beginnings of the driver's messages when a connection could not be made."""

CHECK = ". Check the URL of the database (PLACECELL_DATABASE, --database), and that its server runs"


def is_lost(error: psycopg.Error) -> bool:
    """Return whether the connection is lost, or leads to a server that takes no writes."""
    return kind_of(error) in {"unreachable", "read-only"}


def is_busy(error: psycopg.Error) -> bool:
    """Return whether another transaction was in the way."""
    return kind_of(error) == "busy"


def kind_of(error: psycopg.Error) -> Trouble:
    """Return the kind of an error."""
    return _meaning_of(error)[0]


def translated(error: psycopg.Error) -> StoreError:
    """Return the store's error for one of PostgreSQL."""
    kind, meaning = _meaning_of(error)
    told = " ".join(str(error).split()).rstrip(".?")
    code = f" ({error.sqlstate})" if error.sqlstate else ""
    remedy = CHECK if not code and told.startswith(NOT_CONNECTED) else ""
    return StoreError(kind, f"PostgreSQL: {meaning}{code}: {told:.300}{remedy}")


def _meaning_of(error: psycopg.Error) -> tuple[Trouble, str]:
    code = error.sqlstate or ""
    for beginnings, kind, meaning in _KINDS:
        if code and code.startswith(beginnings):
            return kind, meaning
    if not code and isinstance(error, psycopg.OperationalError):
        # The connection could not be made, or was lost; the server gave no code.
        if "session is read-only" in str(error):
            return "read-only", "the database is read-only, as a standby is"
        return "unreachable", "the database cannot be reached"
    if isinstance(error, errors.InvalidAuthorizationSpecification | errors.InvalidPassword):
        return "failing", "the database refuses the user"
    return "failing", "the database fails"
