"""Trajectories: poses over time, in the files of other programs."""
