"""Streets: terrain, street plan, street network and routes."""
