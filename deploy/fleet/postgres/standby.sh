#!/bin/sh
# Start a server: standby.sh PRIMARY COMMAND... With an empty volume, it copies the primary's files
# first and becomes its standby. Without a PRIMARY ("") it is a primary of its own.
# PGPASSWORD holds the password of the user placecell.
set -eu
primary=$1
shift
if [ -n "$primary" ] && [ ! -s "$PGDATA/PG_VERSION" ]; then
    # A copy that was interrupted must not look like a complete one.
    copy=$PGDATA.unfinished
    rm -rf "$copy"
    mkdir -p "$(dirname "$PGDATA")"
    chown -R postgres "$(dirname "$PGDATA")"
    gosu postgres pg_basebackup --pgdata "$copy" --checkpoint fast --write-recovery-conf \
        --dbname "host=$primary user=placecell password=$PGPASSWORD application_name=$(hostname)"
    # After a promotion it takes writes alone, until the other server is its standby.
    echo "synchronous_standby_names = ''" >> "$copy/postgresql.auto.conf"
    rm -rf "$PGDATA"
    mv "$copy" "$PGDATA"
fi
exec docker-entrypoint.sh "$@"
