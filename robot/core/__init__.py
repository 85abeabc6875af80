"""Types of the agent: settings, state, the correction of the odometry, calls to the service."""
