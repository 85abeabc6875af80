"""Settings of the server, and rights of its user, on which writes depend."""

from collections.abc import Iterator

from service.maps.postgres.tables import SCHEMA
from service.maps.sql.rows import Rows

PROMISE = "Until then, an acknowledged write can be lost when the machine of the primary fails."


def durability_warnings(rows: Rows) -> Iterator[str]:
    """Yield a warning for each setting with which an acknowledged write can be lost."""
    names = ("fsync", "full_page_writes", "synchronous_commit", "synchronous_standby_names")
    settings = {name: rows.execute(f"SHOW {name}").fetchone()[0] for name in names}
    for name in ("fsync", "full_page_writes"):
        if settings[name] != "on":
            yield (
                f"PostgreSQL runs with {name}={settings[name]}: a power failure can lose or damage "
                f"all maps. Set it to on."
            )
    if settings["synchronous_commit"] not in {"on", "remote_apply"}:
        yield (
            f"PostgreSQL runs with synchronous_commit={settings['synchronous_commit']}. "
            f"Set it to on. {PROMISE}"
        )
    if not settings["synchronous_standby_names"]:
        yield (
            "PostgreSQL has no synchronous standby. Add two standbys and set "
            f"synchronous_standby_names = 'ANY 1 (*)'. {PROMISE}"
        )
        return
    (connected,) = rows.execute(
        "SELECT count(*) FROM pg_stat_replication WHERE coalesce(sync_state, '') <> 'async'"
    ).fetchone()
    if not connected:
        yield (
            "No synchronous standby is connected to PostgreSQL, so writes wait for one. "
            "Start a standby."
        )


def right_warnings(rows: Rows) -> Iterator[str]:
    """Yield a warning if the user may not write the tables."""
    user, may_write = rows.execute(
        "SELECT current_user, bool_and(has_table_privilege(oid, 'INSERT') "
        "AND has_table_privilege(oid, 'UPDATE') AND has_table_privilege(oid, 'DELETE')) "
        "FROM pg_class WHERE relkind = 'r' AND relname <> 'version' "
        "AND relnamespace = to_regnamespace(?)",
        (SCHEMA,),
    ).fetchone()
    if not may_write:
        yield (
            f"The user {user!r} of the database may read the maps and not write them. Use the "
            f"owner of the schema {SCHEMA}, or grant INSERT, UPDATE and DELETE on its tables."
        )
