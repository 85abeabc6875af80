"""Demo: two robots share a map and localize in it."""
