"""Synthetic maps of any size, with descriptors sampled from a recording.

Each object of the map has the descriptor of a real segment. If the map needs more objects than the
recording has segments, an object gets the mean of two real descriptors, times the square root of
two to keep the spread (descriptors scatter about 0). Each view of an object, in the map and in a
query, adds a difference between two real descriptors. The two segments belong to one group and
were seen from at least 5 m apart, so the difference is that of two real views of one object.
"""

from dataclasses import dataclass

import numpy as np

from placecell.core.types import Float32, Int8, Int64
from placecell.descriptors.extractor import Extractor
from placecell.descriptors.manifest import Manifest
from placecell.segmentation.recording import Recording

VIEWS = 4
"""Views of each object in the map."""

MIN_VIEWPOINT_DISTANCE_M = 5.0
"""Smallest distance between the viewpoints of two views; closer views are too easy to match."""


@dataclass(frozen=True, slots=True, eq=False)
class SampledMap:
    """Descriptors of a map and of queries.

    Attributes:
        model_id: id of the model that made the descriptors.
        codes: int8 (n, code bytes), descriptors of the map.
        objects: int64 (n,), object that each segment of the map is a view of.
        query_codes: int8 (q, code bytes), descriptors of the queries: further views.
        query_objects: int64 (q,), object that each query is a view of.
    """

    model_id: str
    codes: Int8
    objects: Int64
    query_codes: Int8
    query_objects: Int64


@dataclass(frozen=True, slots=True, eq=False)
class DescriptorSampler:
    """Sampler of descriptors: real descriptors, and real differences between views.

    Attributes:
        manifest: manifest of the model.
        descriptors: float32 (n, d), descriptors of real segments, one per group.
        differences: float32 (m, d), differences between two descriptors of one group.
    """

    manifest: Manifest
    descriptors: Float32
    differences: Float32

    @classmethod
    def from_recording(
        cls, extractor: Extractor, recording: Recording, seed: int
    ) -> "DescriptorSampler":
        """Describe a recording and collect the differences between views.

        Args:
            extractor: describes the segments.
            recording: the segments of a drive.
            seed: random seed of the pairs of views.

        Raises:
            ValueError: no group was seen from two viewpoints far enough apart.
        """
        around = extractor.manifest.neighborhood
        chosen = np.flatnonzero(recording.distinct)
        seen = None if around is None else recording.neighborhood(around)[chosen]
        found = extractor.describe(recording.segments.take(chosen), seen)
        groups = recording.groups[chosen]
        # Segments are in random order within their group; each is paired with the next.
        shuffled = np.random.default_rng(seed).permutation(len(groups))
        order = shuffled[np.argsort(groups[shuffled], kind="stable")]
        sensors = recording.segments.sensors[chosen][order]
        same = groups[order[1:]] == groups[order[:-1]]
        same &= np.linalg.norm(np.diff(sensors, axis=0), axis=1) >= MIN_VIEWPOINT_DISTANCE_M
        if not same.any():
            raise ValueError(
                f"{recording.name}: no group was seen from two viewpoints at least "
                f"{MIN_VIEWPOINT_DISTANCE_M:g} m apart. Use a longer drive."
            )
        _, first = np.unique(groups[order], return_index=True)
        differences = found[order[1:][same]] - found[order[:-1][same]]
        return cls(extractor.manifest, found[order[first]], differences)

    def sample_map(self, count: int, queries: int, seed: int) -> SampledMap:
        """Sample a map of `count` segments, and queries for objects of the map."""
        random = np.random.default_rng(seed)
        objects = np.arange(count) // VIEWS
        number = int(objects[-1]) + 1
        queried = random.choice(number, queries, replace=queries > number)
        base = self.sample_objects(number, random)
        return SampledMap(
            self.manifest.model_id,
            np.concatenate(
                [
                    self.sample_views(base, some, random)
                    for some in np.array_split(objects, 1 + count // 50_000)
                ]
            ),
            objects,
            self.sample_views(base, queried, random),
            queried,
        )

    def sample_objects(self, count: int, random: np.random.Generator) -> Float32:
        """Sample the descriptors of `count` objects, float32 (count, d)."""
        known = self.descriptors
        real = known[random.permutation(len(known))[:count]]
        pairs = random.integers(len(known), size=(count - len(real), 2))
        mixed = (known[pairs[:, 0]] + known[pairs[:, 1]]) * np.float32(np.sqrt(0.5))
        return np.concatenate([real, mixed])

    def sample_views(self, base: Float32, objects: Int64, random: np.random.Generator) -> Int8:
        """Sample one view of each of these objects, int8 (n, code bytes).

        Args:
            base: float32 (number of objects, d), the descriptor of each object.
            objects: int64 (n,), objects to view.
            random: random generator.
        """
        rows = random.integers(len(self.differences), size=len(objects))
        return self.manifest.quantizer.encode(base[objects] + self.differences[rows])
