"""Descriptor compression: bytes per segment against recognition, on a drive."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import faiss
import numpy as np

from evaluation.figure import figure
from evaluation.machine import machine
from evaluation.recognition.evaluate import retrieval
from placecell.core.types import Bool, Float32
from placecell.descriptors.extractor import Extractor
from placecell.descriptors.quantizer import LEVELS, Quantizer
from placecell.segmentation.recording import Recording

PRODUCT_BYTES = (8, 16, 32, 64)


def measure_compression(
    extractor: Extractor, recording: Recording, scans: tuple[int, int]
) -> dict[str, Any]:
    """Measure recognition with each storage format of a model's descriptors.

    Args:
        extractor: describes the segments.
        recording: the segments of a drive.
        scans: first and last scan whose segments are the queries. Quantizers are fitted to the
            segments of all other scans.

    Raises:
        ValueError: the scans hold fewer than 100 segments, or the others fewer than 1,000.
    """
    tested = recording.within(*scans) & recording.distinct
    fitted = ~recording.within(*scans) & recording.distinct
    if tested.sum() < 100 or fitted.sum() < 1000:
        raise ValueError(
            f"{recording.name}: scans {scans[0]} to {scans[1]} have {int(tested.sum())} segments, "
            f"all others {int(fitted.sum())}. At least 100 and 1,000 are needed."
        )
    around = extractor.manifest.neighborhood
    seen = None if around is None else recording.neighborhood(around)
    found = extractor.describe(recording.segments, seen)
    chosen = np.flatnonzero(tested)
    segments, groups = recording.segments.take(chosen), recording.groups[chosen]
    shipped = extractor.manifest.quantizer
    rows = [
        {"storage": name, "bytes": size, "shipped": name == "as shipped"}
        | retrieval(stored, segments, groups)
        for name, size, stored in storage_formats(found, tested, fitted, shipped)
    ]
    return {
        "rows": rows,
        "model_id": extractor.manifest.model_id,
        "drive": recording.name,
        "scans": list(scans),
        "segments": len(chosen),
        "fitted_to": int(fitted.sum()),
        "protocol": recording.parameters.protocol,
        "machine": machine(),
    }


def storage_formats(
    found: Float32, tested: Bool, fitted: Bool, shipped: Quantizer
) -> Iterator[tuple[str, float, Float32]]:
    """Yield name, bytes per segment, and the decoded test descriptors of each storage format."""
    asked, known = found[tested], found[fitted]
    dimension = found.shape[1]
    yield "float32", 4.0 * dimension, asked
    yield "float16", 2.0 * dimension, asked.astype(np.float16).astype(np.float32)
    for per_byte, levels in LEVELS.items():
        if dimension % per_byte == 0:
            quantizer = Quantizer.fit(known, per_byte)
            yield (
                f"{levels} levels",
                dimension / per_byte,
                quantizer.decode(quantizer.encode(asked)),
            )
    yield "as shipped", shipped.code_bytes(dimension), shipped.decode(shipped.encode(asked))
    for size in PRODUCT_BYTES:
        if dimension % size == 0:
            product = faiss.ProductQuantizer(dimension, size, 8)
            product.cp.min_points_per_centroid = 1  # silences a warning: a drive has few segments
            product.train(np.ascontiguousarray(known))
            back = product.decode(product.compute_codes(asked))  # type: ignore[call-arg,func-returns-value]
            yield f"product, {size} parts", size, np.asarray(back)


def draw_compression(report: dict[str, Any], file: Path) -> None:
    """Plot recognition against bytes per descriptor."""
    with figure(file, 2, size=4) as axes:
        for axis, key in zip(axes, ("top1", "recall_at_25"), strict=True):
            for kind, marker in (("product", "s"), ("", "o")):
                rows = [row for row in report["rows"]
                        if row["storage"].startswith("product") == bool(kind)]  # fmt: skip
                rows.sort(key=lambda row: row["bytes"])
                axis.plot(
                    [row["bytes"] for row in rows],
                    [row[key] for row in rows],
                    f"{marker}-",
                    label="product quantization" if kind else "scalar quantization",
                )
            for row in report["rows"]:
                if row["shipped"]:
                    axis.plot(row["bytes"], row[key], "k*", markersize=14, label="as shipped")
            axis.set(xscale="log", xlabel="bytes per descriptor", ylabel=key)
            axis.grid(alpha=0.3)
        axes[0].legend(fontsize=8)
