"""The HTTP routes, one noun a file: they read a request, call the rest, and write a response."""
