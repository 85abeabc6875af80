"""Request and response bodies: JSON, msgpack and compression."""
