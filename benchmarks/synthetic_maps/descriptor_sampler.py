"""Maps of any size from the descriptors of a recording: things seen several times, and asked for.

A thing's descriptor is that of a real segment; of more things than there are, the mean of two real
segments' times the root of two, which keeps their spread (descriptors lie about 0). Each view of a
thing, in the map or asked for, adds the difference between two real segments of one group that were
seen from 5 m apart or more, drawn at random: what really separates views of one thing.
"""

from dataclasses import dataclass

import numpy as np

from placecell.core.types import Float32, Int8, Int64
from placecell.descriptors.extractor import Extractor
from placecell.descriptors.manifest import Manifest
from placecell.segmentation.recording import Recording

VIEWS = 4
"""Of each thing in the map."""

APART = 5.0
"""Metres between the places that two views are from: nearer ones are too easy to find."""


@dataclass(frozen=True, slots=True, eq=False)
class SampledMap:
    """Segments of a map, and queries.

    Attributes:
        model_id: of the model that made the descriptors.
        codes: int8 (n, code bytes), of the map.
        things: int64 (n,), what each is a view of.
        asked: int8 (q, code bytes), further views.
        asked_things: int64 (q,).
    """

    model_id: str
    codes: Int8
    objects: Int64
    query_codes: Int8
    query_objects: Int64


@dataclass(frozen=True, slots=True, eq=False)
class DescriptorSampler:
    """What real segments look like, and how views of one thing differ.

    Attributes:
        manifest: of the model.
        found: float32 (n, d), descriptors of real segments, one a group.
        apart: float32 (m, d), differences between two of one group.
    """

    manifest: Manifest
    found: Float32
    apart: Float32

    @classmethod
    def from_recording(
        cls, extractor: Extractor, recording: Recording, seed: int
    ) -> "DescriptorSampler":
        """From a recording.

        Raises:
            ValueError: no group was seen from places far enough apart.
        """
        around = extractor.manifest.neighborhood
        chosen = np.flatnonzero(recording.distinct)
        seen = None if around is None else recording.neighborhood(around)[chosen]
        found = extractor.describe(recording.segments.take(chosen), seen)
        groups = recording.groups[chosen]
        # In random order within their groups: each with the next of its group.
        shuffled = np.random.default_rng(seed).permutation(len(groups))
        order = shuffled[np.argsort(groups[shuffled], kind="stable")]
        sensors = recording.segments.sensors[chosen][order]
        same = groups[order[1:]] == groups[order[:-1]]
        same &= np.linalg.norm(np.diff(sensors, axis=0), axis=1) >= APART
        if not same.any():
            raise ValueError(f"{recording.name}: no group was seen from {APART:g} m apart")
        _, first = np.unique(groups[order], return_index=True)
        apart = found[order[1:][same]] - found[order[:-1][same]]
        return cls(extractor.manifest, found[order[first]], apart)

    def sample_map(self, count: int, queries: int, seed: int) -> SampledMap:
        """A map of so many segments, and queries for things in it."""
        random = np.random.default_rng(seed)
        things = np.arange(count) // VIEWS
        asked = random.choice(things[-1] + 1, queries, replace=queries > things[-1] + 1)
        base = self.sample_objects(int(things[-1]) + 1, random)
        return SampledMap(
            self.manifest.model_id,
            np.concatenate(
                [
                    self.sample_views(base, some, random)
                    for some in np.array_split(things, 1 + count // 50_000)
                ]
            ),
            things,
            self.sample_views(base, asked, random),
            asked,
        )

    def sample_objects(self, count: int, random: np.random.Generator) -> Float32:
        """Draw descriptors of `count` things, float32 (count, d)."""
        real = self.found[random.permutation(len(self.found))[:count]]
        pairs = random.integers(len(self.found), size=(count - len(real), 2))
        mixed = (self.found[pairs[:, 0]] + self.found[pairs[:, 1]]) * np.float32(np.sqrt(0.5))
        return np.concatenate([real, mixed])

    def sample_views(self, base: Float32, things: Int64, random: np.random.Generator) -> Int8:
        """Draw a view of each of these things, int8 (n, code bytes)."""
        apart = self.apart[random.integers(len(self.apart), size=len(things))]
        return self.manifest.quantizer.encode(base[things] + apart)
