from dataclasses import dataclass
from enum import Enum


class DurabilityPolicy(Enum):
    TRANSIENT_LOCAL = 1
    VOLATILE = 2


class ReliabilityPolicy(Enum):
    RELIABLE = 1
    BEST_EFFORT = 2


@dataclass(frozen=True)
class QoSProfile:
    depth: int
    durability: DurabilityPolicy = DurabilityPolicy.VOLATILE
    reliability: ReliabilityPolicy = ReliabilityPolicy.RELIABLE


qos_profile_sensor_data = QoSProfile(5, reliability=ReliabilityPolicy.BEST_EFFORT)
