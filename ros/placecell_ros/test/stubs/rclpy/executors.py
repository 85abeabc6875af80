class ExternalShutdownException(Exception):  # noqa: N818 rclpy names it so
    pass
