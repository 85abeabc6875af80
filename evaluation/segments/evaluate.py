"""Report of a drive's segments: how well their class and shape are stored."""

from pathlib import Path
from typing import Any

from evaluation.segments.classes import class_figures
from evaluation.segments.shapes import shape_figures
from placecell.core.types import UInt8
from placecell.descriptors.extractor import load_extractor
from placecell.segmentation.recording import Recording
from placecell.shapes.decoder import load_shape_decoder


def evaluate_recording(
    recording: Recording,
    labels: UInt8 | None,
    folder: Path,
    training: Recording | None = None,
) -> dict[str, Any]:
    """Return the figures of a recording's segments.

    Args:
        recording: segments.
        labels: true class index of each segment (`class_figures`); None without labels.
        folder: folder of the model.
        training: segments that the model was trained on, for the baseline of the shapes; None: no
            baseline.
    """
    extractor = load_extractor(folder)
    manifest = extractor.manifest
    around = manifest.neighborhood
    seen = None if around is None else recording.neighborhood(around)
    described = extractor.description(recording.segments, seen)
    return {
        "drive": recording.name,
        "model_id": manifest.model_id,
        "protocol": recording.parameters.protocol,
        "segments": len(recording.segments),
        "captures": len(recording.capture_scans),
        "seen_in_training": manifest.has_seen(recording.scan_hashes),
        "bytes": {
            "code": manifest.code_bytes,
            "classes": 0 if described.classes is None else 1,
            "extents": 3,
        },
        **class_figures(labels, described.classes),
        **shape_figures(
            recording.segments,
            described.values,
            extractor,
            load_shape_decoder(folder, manifest),
            training,
        ),
    }
