"""Shape of a stored segment."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, eq=False)
class SegmentShape:
    """Shape of a stored segment, decoded from its code and its box.

    Attributes:
        id: Id of the segment.
        model_id: Model of the code and of the decoder.
        bytes: Bytes of the map that the shape was decoded from.
        voxel_m: Edge length of a voxel, meters.
        points: Centers of the occupied voxels in the map's frame, float64 (n, 3), meters.
        class_name: Class of the segment; None if it is not known.
    """

    id: int
    model_id: str
    bytes: int
    voxel_m: float
    points: NDArray[np.float64]
    class_name: str | None
