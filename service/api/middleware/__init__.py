"""Middleware: request log, body limit, origin guard and HEAD requests."""
