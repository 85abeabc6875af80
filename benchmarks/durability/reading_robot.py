"""A robot that reads other robots' maps all the time, and sees each whole or not at all."""

import random
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from placecell_client import (
    Client,
    Description,
    MapCopy,
    MapFileError,
    ServiceError,
    decode,
    encode,
)

from benchmarks.synthetic_maps.random_maps import MapTemplate

QUERIES = 5
PAGE = 3_000
"""Segments in a part of what is pulled."""


@dataclass(slots=True)
class ReadingRobot:
    """Reads.

    Attributes:
        template: of the maps' segments.
        has_been: of each map, whether a file is one that its writers ever sent or made of it.
        draw: what it reads next.
        reads: how many there were.
        half: maps that never were, told.
    """

    template: MapTemplate
    has_been: Mapping[str, Callable[[bytes], bool]]
    draw: random.Random
    reads: int = 0
    half: list[str] = field(default_factory=list)
    _copies: dict[str, MapCopy] = field(default_factory=dict)

    def read(self, client: Client) -> None:
        """Look at one map, in one way.

        Raises:
            httpx.TransportError: the service is not there.
            ServiceError: it failed.
        """
        name = self.draw.choice([*self.has_been])
        try:
            self.draw.choice([self._download, self._sync, self._match])(client, name)
        except ServiceError as error:
            if error.status != 404:  # it was removed just now
                raise
        except MapFileError as error:
            self.half.append(f"map {name!r}: {error}")
        self.reads += 1

    def _download(self, client: Client, name: str) -> None:
        file = client.get_map_file(name)
        decode(file)
        self._check(name, file, "downloaded")

    def _sync(self, client: Client, name: str) -> None:
        copy = self._copies.setdefault(name, MapCopy(name))
        client.pull(copy, PAGE)
        assert copy.content is not None
        self._check(name, encode(copy.content), f"pulled to {copy.etag}")

    def _match(self, client: Client, name: str) -> None:
        random = np.random.default_rng(self.draw.getrandbits(64))
        codes = random.integers(-127, 128, (QUERIES, self.template.code_bytes)).astype(np.int8)
        nothing = np.zeros((QUERIES, 0))
        queries = Description(
            self.template.model_id, codes, nothing.astype(np.float32), nothing, errors={}
        )
        client.match(queries, maps=[name], k=3)

    def _check(self, name: str, file: bytes, how: str) -> None:
        if not self.has_been[name](file):
            self.half.append(f"map {name!r}, {how}, never was so")
