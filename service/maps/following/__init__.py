"""Followers: keep the maps in memory level with a store that several services write to."""
