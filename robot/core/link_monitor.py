"""Link monitor: whether the service was reached by the last call."""

from robot.core.status import LinkState


class LinkMonitor:
    """State of the link, told by the last call that was answered or failed."""

    def __init__(self) -> None:
        self.state = LinkState.UNKNOWN

    @property
    def is_offline(self) -> bool:
        """Whether the last call did not reach the service."""
        return self.state is LinkState.OFFLINE

    def note(self, was_reached: bool) -> None:
        """Note whether a call reached the service."""
        self.state = LinkState.ONLINE if was_reached else LinkState.OFFLINE
