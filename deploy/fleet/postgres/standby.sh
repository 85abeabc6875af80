#!/bin/sh
# Start a standby: standby.sh PRIMARY COMMAND... The first start copies the primary's files.
# PGPASSWORD holds the password of the user placecell.
set -eu
primary=$1
shift
if [ ! -s "$PGDATA/PG_VERSION" ]; then
    mkdir -p "$PGDATA"
    chown -R postgres "$(dirname "$PGDATA")"
    chmod 700 "$PGDATA"
    gosu postgres pg_basebackup --pgdata "$PGDATA" --checkpoint fast --write-recovery-conf \
        --dbname "host=$primary user=placecell password=$PGPASSWORD application_name=$(hostname)"
    # After a promotion it takes writes alone, until the other server is its standby.
    echo "synchronous_standby_names = ''" >> "$PGDATA/postgresql.auto.conf"
fi
exec docker-entrypoint.sh "$@"
