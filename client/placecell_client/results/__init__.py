"""Typed results of the service."""
