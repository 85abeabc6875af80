"""Schemas of requests and responses, one topic a file."""
