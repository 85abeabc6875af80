"""Place recognition with 3D segments: read a drive, segment it, describe, localize, align maps.

    import placecell

    drive = placecell.open_drive("drives/00")  # KITTI odometry or raw layout
    parameters = placecell.Parameters().for_drive(len(drive))
    extractor = placecell.load_extractor(placecell.model_folder("context"))
    for scan, segments in placecell.segment_captures(drive, parameters):
        centroids = segments.centroids()  # float64 (segments, 3), meters, world frame
        descriptors = extractor.describe(segments)  # float32 (segments, dimension)
        print(scan, len(segments), descriptors.shape)

`placecell.localize` estimates a robot's pose in a map from `placecell.Candidates`: the most similar
map segments of each segment. `placecell.align` estimates the transform between two maps. Each name
is imported at its first use. The library needs neither torch nor a web framework.
"""

import os
from importlib import import_module
from typing import TYPE_CHECKING, Any

from placecell.core.processors import limit_threads

if TYPE_CHECKING:
    from placecell.core.parameters import Parameters
    from placecell.core.segments import Segments
    from placecell.datasets import Drive, DriveError, open_drive
    from placecell.descriptors.extractor import Extractor, load_extractor
    from placecell.descriptors.shipped_models import model_folder
    from placecell.localization import Candidates, Localization, Pose, localize
    from placecell.map_alignment import MapAlignment, MapView, align
    from placecell.segmentation.pipeline import record, segment_captures, segment_map
    from placecell.segmentation.recording import Recording

__all__ = [
    "Candidates",
    "Drive",
    "DriveError",
    "Extractor",
    "Localization",
    "MapAlignment",
    "MapView",
    "Parameters",
    "Pose",
    "Recording",
    "Segments",
    "align",
    "load_extractor",
    "localize",
    "model_folder",
    "open_drive",
    "record",
    "segment_captures",
    "segment_map",
]

# ONNX Runtime sends usage data to its vendor unless this is set before it is imported.
os.environ.setdefault("ORT_DISABLE_TELEMETRY", "1")

# BLAS and OpenMP start one thread per host core unless limited before they are imported.
limit_threads()

_MODULES = {
    "core.parameters": ("Parameters",),
    "core.segments": ("Segments",),
    "datasets": ("Drive", "DriveError", "open_drive"),
    "descriptors.extractor": ("Extractor", "load_extractor"),
    "descriptors.shipped_models": ("model_folder",),
    "localization": ("Candidates", "Localization", "Pose", "localize"),
    "map_alignment": ("MapAlignment", "MapView", "align"),
    "segmentation.pipeline": ("record", "segment_captures", "segment_map"),
    "segmentation.recording": ("Recording",),
}
"""Public names by the module that defines them."""


def __getattr__(name: str) -> Any:
    """Import a public name at its first use.

    Raises:
        AttributeError: The package has no such public name.
    """
    for module, names in _MODULES.items():
        if name in names:
            value = getattr(import_module(f"placecell.{module}"), name)
            globals()[name] = value
            return value
    raise AttributeError(f"module 'placecell' has no attribute {name!r}")


def __dir__() -> list[str]:
    """List the public names, for completion in a notebook."""
    return sorted({*globals(), *__all__})
