"""Tables of `maps.sqlite` and their migrations."""

import secrets
import sqlite3

from service.maps.sql.owners import Owners
from service.maps.sql.tables import HEAD, head_from, save_head

VERSION = 3

SCHEMA = """
CREATE TABLE maps (
    map INTEGER PRIMARY KEY,
    name TEXT NOT NULL UNIQUE,
    uid TEXT NOT NULL UNIQUE,
    sequence INTEGER NOT NULL,
    mark TEXT NOT NULL,
    base INTEGER NOT NULL,
    next_id INTEGER NOT NULL,
    base_bytes INTEGER NOT NULL,
    log_bytes INTEGER NOT NULL,
    end_id INTEGER NOT NULL DEFAULT 4294967296,
    digest TEXT NOT NULL DEFAULT ''
) STRICT;
CREATE TABLE commits (
    map INTEGER NOT NULL REFERENCES maps,
    sequence INTEGER NOT NULL,
    time REAL NOT NULL,
    author TEXT NOT NULL,
    operation TEXT NOT NULL,
    changed INTEGER NOT NULL,
    removed INTEGER NOT NULL,
    mark TEXT NOT NULL,
    bytes INTEGER NOT NULL,
    delta BLOB,
    link TEXT NOT NULL DEFAULT '',
    PRIMARY KEY (map, sequence)
) STRICT;
CREATE TABLE bases (
    map INTEGER NOT NULL REFERENCES maps,
    part INTEGER NOT NULL,
    sha256 TEXT NOT NULL,
    data BLOB NOT NULL,
    PRIMARY KEY (map, part)
) STRICT;
CREATE TABLE owners (
    map INTEGER NOT NULL REFERENCES maps,
    first INTEGER NOT NULL,
    until INTEGER NOT NULL,
    author TEXT NOT NULL,
    reserved REAL,
    digest TEXT NOT NULL,
    PRIMARY KEY (map, first)
) STRICT;
CREATE TABLE opened (
    token TEXT NOT NULL
) STRICT;
CREATE TABLE annotations (
    map INTEGER NOT NULL REFERENCES maps,
    kind TEXT NOT NULL,
    name TEXT NOT NULL,
    value TEXT NOT NULL,
    author TEXT NOT NULL,
    time REAL NOT NULL,
    digest TEXT NOT NULL,
    PRIMARY KEY (map, kind, name)
) STRICT;
"""


def fill(connection: sqlite3.Connection) -> None:
    """Insert the rows that every database has."""
    connection.execute("INSERT INTO opened VALUES (?)", (secrets.token_hex(16),))


def migrate(connection: sqlite3.Connection) -> None:
    """Migrate a database from version 1 to version 2, within a transaction.

    Commits stay as they are: their link is empty, and their mark covers no note.
    """
    connection.execute("ALTER TABLE maps ADD COLUMN end_id INTEGER NOT NULL DEFAULT 4294967296")
    connection.execute("ALTER TABLE maps ADD COLUMN digest TEXT NOT NULL DEFAULT ''")
    connection.execute("ALTER TABLE commits ADD COLUMN link TEXT NOT NULL DEFAULT ''")
    for statement in SCHEMA.split(";"):
        if "TABLE owners" in statement or "TABLE opened" in statement:
            connection.execute(statement)
    fill(connection)
    for row, *columns in connection.execute(HEAD.replace("SELECT", "SELECT map,", 1)).fetchall():
        head = save_head(connection, row, head_from(tuple(columns)))
        if head.next_id:  # the owners of these ids are not known
            Owners(connection, row).write([(0, head.next_id)], "")


def add_annotations(connection: sqlite3.Connection) -> None:
    """Migrate a database from version 2 to version 3, within a transaction."""
    for statement in SCHEMA.split(";"):
        if "TABLE annotations" in statement:
            connection.execute(statement)
