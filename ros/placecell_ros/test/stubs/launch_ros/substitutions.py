from dataclasses import dataclass


@dataclass
class FindPackageShare:
    package: str
