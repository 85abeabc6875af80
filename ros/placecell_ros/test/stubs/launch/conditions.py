from dataclasses import dataclass
from typing import Any


@dataclass
class IfCondition:
    expression: Any
