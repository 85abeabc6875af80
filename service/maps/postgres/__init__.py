"""Map store in PostgreSQL: the logs of all maps in one database that several services use."""
