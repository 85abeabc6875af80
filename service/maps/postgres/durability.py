"""Settings of the server on which the promise of a write depends."""

from collections.abc import Iterator

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
