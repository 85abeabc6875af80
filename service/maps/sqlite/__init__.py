"""Map store in SQLite: the log of each map in one database file."""
