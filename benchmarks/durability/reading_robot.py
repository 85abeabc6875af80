"""Robot that reads the maps of others all the time and checks that each is complete."""

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
"""Segments per page of a pull."""


@dataclass(slots=True)
class ReadingRobot:
    """Reading robot.

    Attributes:
        template: template of the maps.
        has_been: for each map, returns whether a file ever was a version of it.
        draw: random generator of the choices.
        reads: number of reads.
        half: description of each file that never was a version.
    """

    template: MapTemplate
    has_been: Mapping[str, Callable[[bytes], bool]]
    draw: random.Random
    reads: int = 0
    half: list[str] = field(default_factory=list)
    _copies: dict[str, MapCopy] = field(default_factory=dict)

    def read(self, client: Client) -> None:
        """Read one map in one way, both chosen at random.

        Raises:
            httpx.TransportError: the service is down.
            ServiceError: the service failed.
        """
        name = self.draw.choice([*self.has_been])
        try:
            self.draw.choice([self._download, self._sync, self._match])(client, name)
        except ServiceError as error:
            if error.status != 404:  # a writer has just deleted the map
                raise
        except MapFileError as error:
            self.half.append(f"Map {name!r}: {error}")
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
            self.half.append(f"Map {name!r}, {how}, is not one of its versions.")
