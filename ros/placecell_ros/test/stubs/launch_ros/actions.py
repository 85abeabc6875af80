from typing import Any


class Node:
    def __init__(self, *, package: str, executable: str, **options: Any) -> None:
        self.package = package
        self.executable = executable
        self.options = options
