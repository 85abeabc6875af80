"""Localize in: fixes, the correction of the odometry, and the state of localization."""
