"""Results of the service as typed classes."""
