"""Evaluation of what a stored segment says: its class and its shape."""
