"""Agent on a robot: localizes in shared maps while driving, and sends what the robot maps."""
