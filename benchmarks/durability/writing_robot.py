"""A robot that writes to a map of its own in every way there is, and keeps a journal."""

import random
from dataclasses import dataclass, field

import numpy as np
from placecell_client import Client, CompactMap, Delta, decode, encode
from placecell_client.maps.edit import apply, take, with_optional

from benchmarks.durability.journal import Journal
from benchmarks.durability.map_versions import VersionHistory
from benchmarks.synthetic_maps.random_maps import EPOCH, MapTemplate
from placecell.core.types import UInt32

KEPT = 10
"""Versions, after which the writer has old ones let go before the service does so by itself."""

OPERATIONS = {
    # How often, where there is a map.
    "put": 2,
    "edit": 8,
    "large edit": 1,
    "restore": 2,
    "age": 1,
    "compact": 1,
    "delete": 1,
}

EDITS = (1, 30, 300)
"""Segments of a delta."""

LARGE_EDIT = 6_000
"""After which the service folds the map's layers, and saves its cache."""

LARGE_BYTES = 3 << 20
"""Of a map, that grows no further."""


@dataclass(slots=True)
class WritingRobot:
    """Does one operation after the other, each once the answer to the last has come.

    Attributes:
        robot: its name.
        template: of its segments.
        journal: of its map.
        large: segments of a map that is put whole.
        draw: what it does next.
        random: what the segments are.
    """

    robot: str
    template: MapTemplate
    journal: Journal
    large: int
    draw: random.Random
    random: np.random.Generator = field(init=False)

    def __post_init__(self) -> None:
        self.random = np.random.default_rng(self.draw.getrandbits(64))

    def choose(self, wanted: str | None = None) -> str:
        """What to do next; as often as not what is wanted, where that can be."""
        known = self.journal.known
        if known is None or len(known.newest.file) > LARGE_BYTES:
            return "put"
        if len(known.versions) >= KEPT:
            return "compact"
        if wanted is not None and self.draw.random() < 0.5:
            return wanted
        return self.draw.choices([*OPERATIONS], [*OPERATIONS.values()])[0]

    def do(self, client: Client, operation: str) -> None:
        """Do it, and write both down: that it is begun, and that it was acknowledged.

        Raises:
            httpx.TransportError: whether it was done is not known.
            ServiceError: the service refused it, or failed.
        """
        known = self.journal.known
        if known is None or operation == "put":
            self._put(client)
        elif operation == "edit":
            self._edit(client, known, self.draw.choice(EDITS))
        elif operation == "large edit":
            self._edit(client, known, LARGE_EDIT)
        elif operation == "restore":
            self._restore(client, known)
        elif operation == "age":
            self._age(client, known)
        elif operation == "compact":
            self._compact(client, known)
        else:
            self._delete(client)

    def _put(self, client: Client) -> None:
        known = self.journal.known
        count = self.draw.choice([self.large, 200, 1])
        first = self.draw.randrange(1_000)
        file = encode(self._made(np.arange(first, first + count, dtype=np.uint32)))
        self.journal.begin(
            "put", VersionHistory.begun(file) if known is None else known.after(file)
        )
        seen = known.newest.tag if known is not None else None
        self.journal.acknowledge(client.put_map(self.journal.name, file, if_match=seen).etag)

    def _edit(self, client: Client, known: VersionHistory, count: int) -> None:
        content = decode(known.newest.file)
        delta = self._delta(content, count)
        self.journal.begin("edit", known.after(encode(apply(content, delta))))
        self.journal.acknowledge(client.edit_map(self.journal.name, delta).etag)

    def _delta(self, content: CompactMap, count: int) -> Delta:
        """Some segments replaced, some added, some removed."""
        order = self.random.permutation(content.ids)
        replaced, removed = order[: count // 3], order[count // 3 : count // 2]
        first = int(content.ids[-1]) + 1 if len(content) else 0
        added = np.arange(first, first + count - count // 3, dtype=np.uint32)
        return Delta(self._made(np.concatenate([replaced, added])), np.sort(removed))

    def _restore(self, client: Client, known: VersionHistory) -> None:
        version = self.draw.choice(known.versions)
        self.journal.begin("restore", known.after(version.file))
        written = client.restore_map(self.journal.name, version.sequence)
        self.journal.acknowledge(written.etag)

    def _age(self, client: Client, known: VersionHistory) -> None:
        content = decode(known.newest.file)
        since = EPOCH + self.draw.randrange(200)
        kept = take(content, np.asarray(with_optional(content, ["seen"]).seen) >= since)
        self.journal.begin("age", known.after(encode(kept)))
        self.journal.acknowledge(client.prune_map(self.journal.name, since).etag)

    def _compact(self, client: Client, known: VersionHistory) -> None:
        keep = self.draw.randint(1, 4)
        self.journal.begin("compact", known.shortened(keep))
        client.compact_map(self.journal.name, keep)
        self.journal.acknowledge()

    def _delete(self, client: Client) -> None:
        self.journal.begin("delete", None)
        client.delete_map(self.journal.name)
        self.journal.acknowledge()

    def _made(self, ids: UInt32) -> CompactMap:
        return self.template.random_map(self.robot, ids, self.random)
