from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class LaunchConfiguration:
    name: str


@dataclass
class PathJoinSubstitution:
    parts: list[Any]
