"""Maps of random segments, for benchmarks that recognize nothing in them."""

from dataclasses import dataclass

import numpy as np
from placecell_client import CompactMap, Info
from placecell_client.maps.edit import empty

from placecell.core.types import UInt32

SEGMENTS_PER_CAPTURE = 30
EPOCH = 1.7e9
"""Earliest time of a capture, Unix seconds."""


@dataclass(frozen=True, slots=True)
class MapTemplate:
    """Model and coordinate frame of random maps.

    Attributes:
        model_id: id of the model that the descriptors appear to come from.
        preprocessing: version of the preprocessing of that model.
        code_bytes: bytes of a descriptor code.
        frame: name of the coordinate frame.
    """

    model_id: str
    preprocessing: str
    code_bytes: int
    frame: str = "bench"

    @classmethod
    def from_info(cls, info: Info) -> "MapTemplate":
        """Return the template for the default model of a service."""
        model = info.model
        return cls(info.model_id, model["preprocessing"]["version"], model["code_bytes"])

    def empty_map(self) -> CompactMap:
        """Return a map without segments."""
        return empty(self.model_id, self.preprocessing, self.frame, self.code_bytes)

    def random_map(self, robot: str, ids: UInt32, random: np.random.Generator) -> CompactMap:
        """Return random segments of a robot; capture times lie up to 1,000 s after `EPOCH`.

        Args:
            robot: name of the robot.
            ids: ids of the segments.
            random: random generator.
        """
        count, captures = len(ids), -(-len(ids) // SEGMENTS_PER_CAPTURE)
        frame_index = (np.arange(count) // SEGMENTS_PER_CAPTURE).astype(np.uint32)
        positions = random.uniform(-500, 500, (captures, 3))
        return CompactMap(
            model_id=self.model_id,
            preprocessing=self.preprocessing,
            frame=self.frame,
            codes=random.integers(-127, 128, (count, self.code_bytes)).astype(np.int8),
            centroids=positions[frame_index] + random.uniform(-40, 40, (count, 3)),
            ids=ids,
            robots=(robot,),
            robot=np.zeros(count, np.uint16),
            frame_index=frame_index,
            frame_times=EPOCH + random.uniform(0, 1_000, captures),
            frame_positions=positions,
            frame_orientations=np.tile(np.array([0, 0, 0, 1], np.float32), (captures, 1)),
        )
