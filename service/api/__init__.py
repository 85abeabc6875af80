"""HTTP API: routes, schemas, bodies, middleware and admission control."""
