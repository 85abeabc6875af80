"""Two stretches of two drives: two maps, and how one lies in the other."""

from dataclasses import dataclass

from placecell.core.types import Float64


@dataclass(frozen=True, slots=True)
class StretchPair:
    """Two stretches of two drives.

    Attributes:
        scans_a, scans_b: first and last scan of each, both included.
        overlap: share of b's scans that were taken in a's streets.
        look_alike: share of b's scans where the same identical houses stand as in a street of a's.
        frame_a, frame_b: (4, 4) world of each drive to the frame of its map: any heading,
            kilometers away.
        b_to_a: (4, 4) map b's frame to map a's, in truth.
    """

    scans_a: tuple[int, int]
    scans_b: tuple[int, int]
    overlap: float
    look_alike: float
    frame_a: Float64
    frame_b: Float64
    b_to_a: Float64

    def as_dict(self) -> dict[str, object]:
        """Plain values for JSON."""
        return {
            "scans_a": self.scans_a,
            "scans_b": self.scans_b,
            "overlap": round(self.overlap, 3),
            "look_alike": round(self.look_alike, 3),
            "frame_a": self.frame_a.tolist(),
            "frame_b": self.frame_b.tolist(),
            "b_to_a": self.b_to_a.tolist(),
        }
