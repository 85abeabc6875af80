"""Schemas of `/scans` as JSON and msgpack: the segments of an uploaded point cloud file."""

from typing import Generic, TypeVar

from pydantic import BaseModel, Field

from service.api.schemas.recognition import Point

PointsT = TypeVar("PointsT")
LabelsT = TypeVar("LabelsT")
ScanSegmentT = TypeVar("ScanSegmentT")
ScanCloudT = TypeVar("ScanCloudT")


class ScanSegment(BaseModel, Generic[PointsT]):
    """Segment of a scan, in either encoding."""

    points: PointsT = Field(
        description="Points of the segment, meters. Send them to `/localize` or `/match`, with the "
        "sensor position."
    )
    centroid: Point = Field(description="Mean of the points, meters.")
    extents: Point = Field(description="Sides x, y, z of the axis-aligned box, meters.")


class ScanCloud(BaseModel, Generic[PointsT, LabelsT]):
    """Points of a scan to show, in either encoding."""

    points: PointsT = Field(
        description="At most 50,000 points, evenly chosen from one for each voxel of 0.1 m, "
        "rounded to 1 cm."
    )
    labels: LabelsT = Field(
        description="Index of each point's segment; -1: ground; -2: in no segment."
    )


class SegmentedScanResponse(BaseModel, Generic[ScanSegmentT, ScanCloudT]):
    """Segments of an uploaded scan, in a level frame whose origin is the sensor."""

    format: str = Field(description="Format of the file, such as `PCD`.")
    points: int = Field(description="Number of points in the file.")
    dropped_points: int = Field(
        description="Number of points that were left out: not finite, or all coordinates 0."
    )
    segments: list[ScanSegmentT]
    sensors: list[Point] = Field(description="Sensor position of each segment: the origin.")
    cloud: ScanCloudT
    transform: list[list[float]] = Field(
        description="Transform (4, 4) from the frame of the file to the frame of the answer."
    )
    sensor_height: float | None = Field(
        description="Height of the sensor above the ground, meters; null if no ground was found."
    )
    problems: list[str] = Field(description="Oddities of the scan, and the assumptions made.")


class ScanSegmentOut(ScanSegment[list[Point]]):
    """Segment of a scan."""


class ScanCloudOut(ScanCloud[list[Point], list[int]]):
    """Points of a scan to show."""


class ScanResponse(SegmentedScanResponse[ScanSegmentOut, ScanCloudOut]):
    """Segments of an uploaded scan, in a level frame whose origin is the sensor."""


class PackedScanSegment(ScanSegment[bytes]):
    """Segment of a scan; points are little-endian float32."""


class PackedScanCloud(ScanCloud[bytes, bytes]):
    """Points of a scan to show, little-endian float32; labels are int32."""


class PackedScanResponse(SegmentedScanResponse[PackedScanSegment, PackedScanCloud]):
    """`ScanResponse` as msgpack."""
