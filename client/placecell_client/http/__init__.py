"""HTTP side of the client: requests, retries, encodings and errors."""
