"""Rows of a database, as sqlite3 gives them; statements have `?` for each value."""

from collections.abc import Iterable, Sequence
from typing import Any, Protocol


class Rows(Protocol):
    """Connection to a database, within a transaction."""

    def execute(self, statement: str, values: Sequence[Any] = (), /) -> Any:
        """Run a statement; return its cursor."""

    def executemany(self, statement: str, values: Iterable[Sequence[Any]], /) -> Any:
        """Run a statement once for each row of values."""
