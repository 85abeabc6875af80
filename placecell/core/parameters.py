"""Parameters of the pipeline from scans to the network's input, named as in the paper.

The defaults are protocol v1, the protocol under which recognition is measured. A result carries the
protocol's name, so results of different protocols are not compared by mistake. Protocol `sparse` is
for drives in which v1 finds few segments.
"""

from dataclasses import asdict, dataclass, replace

import numpy as np

from placecell.core.types import Int64


@dataclass(frozen=True, slots=True)
class Parameters:
    """Constants from scans to the network's input (paper, sections III-A and IV).

    Lengths are in meters. A capture is a scan at which segments are extracted.
    """

    protocol: str = "v1"

    # Accumulation: scans into a local voxel map around the sensor.
    frame_step: int = 2
    """Scans between two captures. (The name is a key of manifests and recordings.)"""
    accumulated_scans: int = 10
    """Number of scans in a capture's local map: its own scan and those before it."""
    min_range: float = 3.0
    """Returns nearer to the sensor are dropped: they are the vehicle itself."""
    max_range: float = 60.0
    """Returns farther away are dropped: they are too sparse to segment."""
    local_map_radius: float = 40.0
    """Horizontal radius of the local map around the sensor's position at capture."""
    map_voxel: float = 0.1
    """Edge length of the local map's voxels. Each holds the mean of its points."""

    # Ground removal, before region growing.
    ground_cell: float = 0.5
    """Edge length of the height grid's cells."""
    ground_window: float = 15.0
    """Objects narrower than this (cars, trucks, trees, walls) do not raise the ground surface."""
    ground_clearance: float = 0.3
    """Points lower than this above the ground surface are ground."""

    # Removal of ceilings, in captures that are indoors.
    ceiling_share: float = 1 / 3
    """Share of the local map's area under a ceiling from which the capture is indoors. Above 1, no
    capture is."""
    ceiling_lowest: float = 1.8
    """Smallest height of a ceiling above the ground."""
    ceiling_highest: float = 8.0
    """Largest height of a ceiling above the ground."""
    door_height: float = 2.0
    """Indoors, points higher than this above the ground are dropped: ceilings, and walls above
    doors, join the rooms of a floor to one region."""

    # Region growing on Euclidean distance.
    growing_radius: float = 0.25
    """Largest distance between two linked points of a region."""
    min_points: int = 100
    """Smallest number of points of a segment, counted in the local map's voxels."""
    max_points: int = 15_000
    """Largest number of points of a segment, counted in the local map's voxels."""

    # Groups of segments over successive captures.
    d_same: float = 1.5
    """Segments of successive captures join a group if their centroids are closer (paper: 1.5 m)."""

    # The network's input.
    grid: tuple[int, int, int] = (38, 38, 18)
    """Number of voxels along x, y, z (paper: 38 x 38 x 18)."""
    grid_voxel: float = 0.2
    """Edge length of the grid's voxels (paper: about 0.2 m, so that 95% of the segments fit)."""
    th_H: int = 50
    """Hamming distance of two grids below which one is a duplicate (paper: 50)."""
    voxel_parts: int = 1
    """Parts along each edge of a voxel, 1 or 2. A voxel's value is the number of parts that hold a
    point: 0 or 1 (paper), or 0 to 8."""

    def __post_init__(self) -> None:
        """Check the parts of a voxel.

        Raises:
            ValueError: `voxel_parts` is neither 1 nor 2.
        """
        if self.voxel_parts not in (1, 2):
            raise ValueError(f"Invalid voxel_parts {self.voxel_parts}: expected 1 or 2")

    def for_drive(self, scans: int, every: int | None = None) -> "Parameters":
        """Return the parameters for a drive: on fewer than 100 scans, every scan is a capture.

        Args:
            scans: number of scans of the drive.
            every: scans between two captures; None follows the protocol.
        """
        step = every if every is not None else (1 if scans < 100 else self.frame_step)
        return replace(self, frame_step=step)

    def for_block(self, scans: int) -> "Parameters":
        """Return the parameters for a block of a drive.

        A block with few scans accumulates fewer, so that it still has several captures.

        Args:
            scans: number of scans of the block.
        """
        accumulated = min(self.accumulated_scans, max(1, scans // 2))
        step = min(self.frame_step, accumulated)
        return replace(self, accumulated_scans=accumulated, frame_step=step)

    def as_dict(self) -> dict[str, object]:
        """Return plain values for a manifest or a report.

        Voxels without parts have no key, so that recordings stay readable for earlier versions.
        """
        values = asdict(self) | {"grid": list(self.grid)}
        if self.voxel_parts == 1:
            del values["voxel_parts"]
        return values


PROTOCOL_V1 = Parameters()

PROTOCOL_SPARSE = Parameters(protocol="sparse", growing_radius=0.5, min_points=20)
"""Parameters for local maps of few points: a few scans of 16 beams, or a narrow view. A wider
growing radius links the returns of neighboring beams, and few points make a segment. Chosen on
simulated drives (docs/results/localization.md)."""

PROTOCOLS = {each.protocol: each for each in (PROTOCOL_V1, PROTOCOL_SPARSE)}
"""Protocols by name."""


@dataclass(frozen=True, slots=True)
class NeighborhoodParameters:
    """Constants of the neighborhood histogram. Lengths are in meters."""

    voxel: float = 0.6
    """Edge length of the voxels that are counted."""
    rings: tuple[int, ...] = (*range(1, 21), 22, 24, 26, 28, 30, 33, 36, 40)
    """Outer radius of each ring, horizontal, whole meters."""
    heights: tuple[float, ...] = (-2.0, -1.0, -0.3, 0.3, 1.0, 2.0, 4.0)
    """Heights between the layers, relative to the segment's centroid. The outer layers are open."""
    sectors: int = 16
    """Number of directions, counted separately and averaged: a dense corner weighs no more."""

    def __post_init__(self) -> None:
        """Check the number of sectors.

        Raises:
            ValueError: `sectors` is not 16.
        """
        if self.sectors != 16:
            raise ValueError(f"Invalid number of sectors {self.sectors}: expected 16")

    def ring_of_meter(self) -> Int64:
        """Return the ring of each whole meter of distance, int64 (reach,)."""
        return np.searchsorted(self.rings, np.arange(self.rings[-1]), side="right")

    @property
    def shape(self) -> tuple[int, int]:
        """Number of rings and of layers."""
        return len(self.rings), len(self.heights) + 1

    @property
    def size(self) -> int:
        """Number of values that describe a segment's neighborhood."""
        rings, layers = self.shape
        return rings * layers


NEIGHBORHOOD_V1 = NeighborhoodParameters()

PREPROCESSING_VERSIONS = {1: "1", 2: "2"}
"""Version of the steps from a segment's points to the network's input, by `voxel_parts`.

Part of a model's id. Earlier versions of Placecell refuse models of a version that they lack.
"""
