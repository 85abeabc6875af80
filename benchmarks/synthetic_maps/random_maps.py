"""Segments made up for the maps of a bench: nothing is recognised in them."""

from dataclasses import dataclass

import numpy as np
from placecell_client import CompactMap, Info
from placecell_client.maps.edit import empty

from placecell.core.types import UInt32

FRAME_SEGMENTS = 30
EPOCH = 1.7e9
"""Unix seconds of the first frame."""


@dataclass(frozen=True, slots=True)
class MapTemplate:
    """What segments of one map have in common.

    Attributes:
        model_id: of the model whose descriptors they pretend to have.
        preprocessing: version of the steps before that model.
        code_bytes: of a descriptor.
        frame: name of the coordinate frame.
    """

    model_id: str
    preprocessing: str
    code_bytes: int
    frame: str = "bench"

    @classmethod
    def from_info(cls, info: Info) -> "MapTemplate":
        """Of the model that a service has loaded."""
        model = info.model
        return cls(info.model_id, model["preprocessing"]["version"], model["code_bytes"])

    def empty_map(self) -> CompactMap:
        """A map without segments."""
        return empty(self.model_id, self.preprocessing, self.frame, self.code_bytes)

    def random_map(self, robot: str, ids: UInt32, random: np.random.Generator) -> CompactMap:
        """A robot's segments of these ids; their frames' times lie within 1,000 s of `EPOCH`."""
        count, frames = len(ids), -(-len(ids) // FRAME_SEGMENTS)
        frame_index = (np.arange(count) // FRAME_SEGMENTS).astype(np.uint32)
        positions = random.uniform(-500, 500, (frames, 3))
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
            frame_times=EPOCH + random.uniform(0, 1_000, frames),
            frame_positions=positions,
            frame_orientations=np.tile(np.array([0, 0, 0, 1], np.float32), (frames, 1)),
        )
