"""Suburb: houses behind gardens, overgrown boundaries, banks, and cars that are partly hidden."""
