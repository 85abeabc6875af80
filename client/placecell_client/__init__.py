"""Client of a Placecell service: HTTP clients, compact map files and delta files."""

from placecell_client.async_client import AsyncClient
from placecell_client.client import Client
from placecell_client.hints import (
    GeoHint,
    Hints,
    LastPoseHint,
    NearHint,
    OutsidePlace,
    SensorPose,
    UnusedHint,
    UsedHints,
    YawHint,
)
from placecell_client.http.errors import ServiceError
from placecell_client.http.events import ServerEvent
from placecell_client.http.point_clouds import PrecisionWarning
from placecell_client.http.retry import Retries
from placecell_client.maps.delta_file import Delta, decode_delta, encode_delta
from placecell_client.maps.map_file import CompactMap, MapFileError, decode, encode
from placecell_client.maps.move import moved, originated
from placecell_client.replica import ChangesPage, MapCopy
from placecell_client.results.alignment import MapAlignment, MapHypothesis, MapPairs, Overlap
from placecell_client.results.anchors import (
    AnchorPose,
    Coverage,
    MapAnchor,
    MapAnchorFit,
    MapMirror,
)
from placecell_client.results.core import (
    Candidate,
    Description,
    Info,
    ItemError,
    Maps,
    MapSummary,
    MapVersion,
    Matches,
    PartialUpload,
    Skipped,
    Written,
)
from placecell_client.results.localization import (
    Hypothesis,
    Inliers,
    Localization,
    Localizations,
    Pose,
    PossiblePlace,
    Rival,
)
from placecell_client.results.merge import MapLoop, Merge, MergedAnchor, MergedPart, MergePair
from placecell_client.results.optimization import (
    GraphLoop,
    GraphPart,
    MovedCapture,
    Optimization,
)
from placecell_client.results.robots import RobotState
from placecell_client.results.scans import AddedScan, KeyScope, ScannedFile

__all__ = [
    "AddedScan",
    "AnchorPose",
    "AsyncClient",
    "Candidate",
    "ChangesPage",
    "Client",
    "CompactMap",
    "Coverage",
    "Delta",
    "Description",
    "GeoHint",
    "GraphLoop",
    "GraphPart",
    "Hints",
    "Hypothesis",
    "Info",
    "Inliers",
    "ItemError",
    "KeyScope",
    "LastPoseHint",
    "Localization",
    "Localizations",
    "MapAlignment",
    "MapAnchor",
    "MapAnchorFit",
    "MapCopy",
    "MapFileError",
    "MapHypothesis",
    "MapLoop",
    "MapMirror",
    "MapPairs",
    "MapSummary",
    "MapVersion",
    "Maps",
    "Matches",
    "Merge",
    "MergePair",
    "MergedAnchor",
    "MergedPart",
    "MovedCapture",
    "NearHint",
    "Optimization",
    "OutsidePlace",
    "Overlap",
    "PartialUpload",
    "Pose",
    "PossiblePlace",
    "PrecisionWarning",
    "Retries",
    "Rival",
    "RobotState",
    "ScannedFile",
    "SensorPose",
    "ServerEvent",
    "ServiceError",
    "Skipped",
    "UnusedHint",
    "UsedHints",
    "Written",
    "YawHint",
    "decode",
    "decode_delta",
    "encode",
    "encode_delta",
    "moved",
    "originated",
]
