"""The operator's page in a real browser: size, speed, memory, pictures."""
