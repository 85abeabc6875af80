"""Pages of the service: the operator's page and the API documentation."""
