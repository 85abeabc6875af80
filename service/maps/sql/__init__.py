"""Statements that the stores on SQLite and PostgreSQL share."""
