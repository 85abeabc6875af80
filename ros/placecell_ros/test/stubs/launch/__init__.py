"""Stand-in for launch: keeps what a launch file describes."""

from typing import Any


class LaunchDescription:
    def __init__(self, entities: list[Any]) -> None:
        self.entities = entities
