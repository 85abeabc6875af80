"""Odometry: the sensor's motion where a source has no poses, and the direction of up."""
