"""Outputs of the agent: events, trajectories, MCAP files, and the interface of all of them."""
