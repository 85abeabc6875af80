from dataclasses import dataclass
from typing import Any


@dataclass
class DeclareLaunchArgument:
    name: str
    default_value: Any = None
    description: str = ""
