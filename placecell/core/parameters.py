"""Every constant of the pipeline, in one place, named as in the paper.

The defaults are **protocol v1**, the protocol under which recognition is measured. A result
carries the protocol's name, so that a figure is never compared with one of another protocol.
"""

from dataclasses import asdict, dataclass, replace

import numpy as np

from placecell.core.types import Int64


@dataclass(frozen=True, slots=True)
class Parameters:
    """Constants from scans to the network's input (paper, sections III-A and IV).

    Lengths are meters, frames are scans of a drive.
    """

    protocol: str = "v1"

    # Accumulation: scans into a local voxel map around the sensor.
    frame_step: int = 2
    """A frame every so many scans."""
    accumulated_scans: int = 10
    """A frame's local map holds its own scan and those before it, so many in all."""
    min_range: float = 3.0
    """Returns nearer to the sensor are dropped (the vehicle itself)."""
    max_range: float = 60.0
    """Returns farther away are dropped (too sparse to segment)."""
    local_map_radius: float = 40.0
    """Horizontal radius of the local map around the sensor's present position."""
    map_voxel: float = 0.1
    """Edge of the local map's voxels; each holds the mean of its points."""

    # Ground removal, before region growing.
    ground_cell: float = 0.5
    """Edge of the height grid's cells."""
    ground_window: float = 15.0
    """Objects narrower than this do not lift the ground: cars, lorries, trees, walls."""
    ground_clearance: float = 0.3
    """Points lower than this above the ground surface are ground."""

    # Region growing on Euclidean distance.
    growing_radius: float = 0.25
    min_points: int = 100
    """Counted after the voxel map, as are all points from there on."""
    max_points: int = 15_000

    # Groups of segments over successive frames.
    d_same: float = 1.5
    """Centroids of successive frames closer than this are the same group (paper: 1.5 m)."""

    # The network's input.
    grid: tuple[int, int, int] = (38, 38, 18)
    """Voxels along x, y, z (paper: 38 x 38 x 18)."""
    grid_voxel: float = 0.2
    """Edge of the grid's voxels (paper: about 0.2 m, so that 95% of the segments fit)."""
    th_H: int = 50
    """Hamming distance of two grids below which one is a duplicate (paper: 50)."""

    def for_drive(self, scans: int, every: int | None = None) -> "Parameters":
        """Protocol v1 takes every second scan, every one on drives of fewer than 100 scans."""
        step = every if every is not None else (1 if scans < 100 else self.frame_step)
        return replace(self, frame_step=step)

    def for_block(self, scans: int) -> "Parameters":
        """The accumulation shrinks where a block has few scans, so that it has several frames."""
        accumulated = min(self.accumulated_scans, max(1, scans // 2))
        step = min(self.frame_step, accumulated)
        return replace(self, accumulated_scans=accumulated, frame_step=step)

    def as_dict(self) -> dict[str, object]:
        """Plain values for a manifest or a report."""
        return asdict(self) | {"grid": list(self.grid)}


PROTOCOL_V1 = Parameters()


@dataclass(frozen=True, slots=True)
class NeighborhoodParameters:
    """Constants of what is counted around a segment. Lengths are meters."""

    voxel: float = 0.6
    """Edge of the voxels that are counted."""
    rings: tuple[int, ...] = (*range(1, 21), 22, 24, 26, 28, 30, 33, 36, 40)
    """Outer radii, horizontal, whole meters."""
    heights: tuple[float, ...] = (-2.0, -1.0, -0.3, 0.3, 1.0, 2.0, 4.0)
    """Limits between the layers, above the segment's centroid; the outer ones are open."""
    sectors: int = 16
    """Directions that are counted apart and averaged: a dense corner weighs no more than others."""

    def __post_init__(self) -> None:
        """Refuse what the counting does not do.

        Raises:
            ValueError: other sectors than 16.
        """
        if self.sectors != 16:
            raise ValueError(f"{self.sectors} sectors; the compass is counted in 16")

    def ring_of_meter(self) -> Int64:
        """Of each whole metre's distance the ring that it begins in, int64 (reach,)."""
        return np.searchsorted(self.rings, np.arange(self.rings[-1]), side="right")

    @property
    def shape(self) -> tuple[int, int]:
        """Rings and layers."""
        return len(self.rings), len(self.heights) + 1

    @property
    def size(self) -> int:
        """Numbers that describe a segment's surroundings."""
        rings, layers = self.shape
        return rings * layers


NEIGHBORHOOD_V1 = NeighborhoodParameters()

PREPROCESSING_VERSION = "1"
"""Version of the steps from a segment's points to the network's input; part of a model's id."""
