"""Core of the service: settings, problems, keys, preconditions, metrics and cost."""
