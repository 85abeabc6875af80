"""HTTP of the client: requests, responses, retries, encodings and errors."""
