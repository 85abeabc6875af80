"""Tables in the schema `placecell` of a database, and their version.

Services of two versions use one database during a rolling update. So a version is MAJOR.MINOR:

- A minor step only adds tables, or columns with a default. A service reads and writes each database
  of its major version, whatever the minor version is.
- A service that starts adds what the database lacks. Older services go on meanwhile.
- A service refuses a database of another major version.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from service.maps.sql.rows import Rows
from service.maps.store import StoreError

SCHEMA = "placecell"
CHANNEL = "placecell"

CREATION_LOCK = 0x506C6C63
"""Advisory lock of the service that creates or migrates the tables."""

MAINTENANCE_LOCK = CREATION_LOCK + 1
"""Advisory lock of the service that compacts histories."""

TABLES = f"""
CREATE SCHEMA IF NOT EXISTS {SCHEMA};
CREATE TABLE {SCHEMA}.version (
    major integer NOT NULL,
    minor integer NOT NULL
);
CREATE TABLE {SCHEMA}.maps (
    map bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
    name text COLLATE "C" NOT NULL UNIQUE,
    uid text COLLATE "C" NOT NULL UNIQUE,
    sequence bigint NOT NULL,
    mark text NOT NULL,
    base bigint NOT NULL,
    next_id bigint NOT NULL,
    base_bytes bigint NOT NULL,
    log_bytes bigint NOT NULL,
    end_id bigint NOT NULL DEFAULT 4294967296,
    digest text NOT NULL DEFAULT '',
    annotated bigint NOT NULL DEFAULT 0
);
CREATE TABLE {SCHEMA}.commits (
    map bigint NOT NULL REFERENCES {SCHEMA}.maps,
    sequence bigint NOT NULL,
    time double precision NOT NULL,
    author text NOT NULL,
    operation text NOT NULL,
    changed bigint NOT NULL,
    removed bigint NOT NULL,
    mark text NOT NULL,
    bytes bigint NOT NULL,
    delta bytea,
    link text NOT NULL DEFAULT '',
    PRIMARY KEY (map, sequence)
);
CREATE TABLE {SCHEMA}.bases (
    map bigint NOT NULL REFERENCES {SCHEMA}.maps,
    part bigint NOT NULL,
    sha256 text NOT NULL,
    data bytea NOT NULL,
    PRIMARY KEY (map, part)
);
CREATE TABLE {SCHEMA}.owners (
    map bigint NOT NULL REFERENCES {SCHEMA}.maps,
    first bigint NOT NULL,
    until bigint NOT NULL,
    author text NOT NULL,
    reserved double precision,
    digest text NOT NULL,
    PRIMARY KEY (map, first)
);
CREATE TABLE {SCHEMA}.annotations (
    map bigint NOT NULL REFERENCES {SCHEMA}.maps,
    kind text COLLATE "C" NOT NULL,
    name text COLLATE "C" NOT NULL,
    value text NOT NULL,
    author text NOT NULL,
    time double precision NOT NULL,
    digest text NOT NULL,
    PRIMARY KEY (map, kind, name)
);
ALTER TABLE {SCHEMA}.commits ALTER COLUMN delta SET STORAGE EXTERNAL;
ALTER TABLE {SCHEMA}.bases ALTER COLUMN data SET STORAGE EXTERNAL;
"""


@dataclass(frozen=True, slots=True)
class PostgresLayout:
    """Tables of this program.

    Attributes:
        major: major version; a database of another one is refused.
        minor: minor version.
        tables: statements that create the tables of this version.
        additions: statements that lead from each earlier minor version to the next one.
    """

    major: int
    minor: int
    tables: str
    additions: Mapping[int, str]

    @property
    def version(self) -> tuple[int, int]:
        """Major and minor version."""
        return self.major, self.minor


LAYOUT = PostgresLayout(1, 0, TABLES, {})


def extend(rows: Rows, layout: PostgresLayout) -> bool:
    """Create the tables, or add what they lack, within a transaction.

    The caller holds `CREATION_LOCK` since before the transaction: within one, the server may have
    cached that the tables are missing.

    Returns:
        Whether a table was created or changed.

    Raises:
        StoreError: the database has another major version.
    """
    if is_current(rows, layout):
        return False
    found = _version_of(rows)
    if found is None:
        rows.execute(layout.tables)
        rows.execute(f"INSERT INTO {SCHEMA}.version VALUES (?, ?)", (layout.major, layout.minor))
        return True
    for minor in range(found[1], layout.minor):
        rows.execute(layout.additions[minor])
    rows.execute(f"UPDATE {SCHEMA}.version SET minor = ?", (layout.minor,))
    return True


def is_current(rows: Rows, layout: PostgresLayout) -> bool:
    """Return whether the database has all tables; StoreError if its major version is another."""
    found = _version_of(rows)
    if found is None:
        return False
    major, minor = found
    if major != layout.major:
        raise StoreError(
            "failing",
            f"The tables of the database have version {major}.{minor}; this program uses versions "
            f"{layout.major}.x. Use a program of the same major version, or move the maps to a "
            "database of their own",
        )
    return minor >= layout.minor


def _version_of(rows: Rows) -> tuple[int, int] | None:
    (is_there,) = rows.execute("SELECT to_regclass(?)", (f"{SCHEMA}.version",)).fetchone()
    if is_there is None:
        return None
    found = rows.execute(f"SELECT major, minor FROM {SCHEMA}.version").fetchone()
    if found is None:
        raise StoreError("damaged", f"The table {SCHEMA}.version is empty; restore the database")
    return int(found[0]), int(found[1])
