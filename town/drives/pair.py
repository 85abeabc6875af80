"""Pair of stretches of two drives: two maps with their true alignment."""

from dataclasses import dataclass

from placecell.core.types import Float64


@dataclass(frozen=True, slots=True)
class StretchPair:
    """Pair of stretches of two drives.

    Attributes:
        scans_a, scans_b: first and last scan of each stretch (included).
        overlap: share of b's scans in streets of a.
        look_alike: share of b's scans in streets with the same identical houses as a street of a.
        frame_a, frame_b: (4, 4), transform from each drive's world to its map's frame, with a
            random heading and kilometers of translation.
        b_to_a: (4, 4), true transform from map b's frame to map a's.
    """

    scans_a: tuple[int, int]
    scans_b: tuple[int, int]
    overlap: float
    look_alike: float
    frame_a: Float64
    frame_b: Float64
    b_to_a: Float64

    def as_dict(self) -> dict[str, object]:
        """Return plain values for JSON."""
        return {
            "scans_a": self.scans_a,
            "scans_b": self.scans_b,
            "overlap": round(self.overlap, 3),
            "look_alike": round(self.look_alike, 3),
            "frame_a": self.frame_a.tolist(),
            "frame_b": self.frame_b.tolist(),
            "b_to_a": self.b_to_a.tolist(),
        }
