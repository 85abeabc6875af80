#!/bin/sh
# Run once by the image of PostgreSQL, after it has made the database: lets the standby connect.
# A commit then waits until one standby has it on its disk.
set -eu
echo "host replication placecell samenet scram-sha-256" >> "$PGDATA/pg_hba.conf"
echo "synchronous_standby_names = 'ANY 1 (*)'" >> "$PGDATA/postgresql.auto.conf"
