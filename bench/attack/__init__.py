"""A standing attack on the service: the faults of load and security, one case each."""
