"""Robot that writes to a map of its own with all operations, and keeps a journal."""

import random
from dataclasses import dataclass, field

import numpy as np
from placecell_client import Client, CompactMap, Delta, decode, encode
from placecell_client.maps.edit import apply, take, with_optional

from benchmarks.durability.journal import Journal
from benchmarks.durability.map_versions import VersionHistory
from benchmarks.synthetic_maps.random_maps import EPOCH, MapTemplate
from placecell.core.types import UInt32

MAX_VERSIONS = 10
"""Number of versions at which the robot compacts the map, before the service does so by itself."""

OPERATIONS = {
    # Relative frequency if there is a map.
    "put": 2,
    "edit": 8,
    "large edit": 1,
    "restore": 2,
    "age": 1,
    "compact": 1,
    "delete": 1,
}

EDITS = (1, 30, 300)
"""Sizes of an edit, in segments."""

LARGE_EDIT = 6_000
"""Size of an edit after which the service merges the layers of the map and writes its cache."""

LARGE_BYTES = 3 << 20
"""Size of a map file from which the robot replaces the map, bytes."""


@dataclass(slots=True)
class WritingRobot:
    """Writing robot; sends an operation when the answer to the last one has arrived.

    Attributes:
        robot: name of the robot.
        template: template of its segments.
        journal: journal of its map.
        large: segments of a large map.
        draw: random generator of the operations.
        random: random generator of the segments.
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
        """Choose the next operation; half of the time `wanted`, if it is possible."""
        known = self.journal.known
        if known is None or len(known.newest.file) > LARGE_BYTES:
            return "put"
        if len(known.versions) >= MAX_VERSIONS:
            return "compact"
        if wanted is not None and self.draw.random() < 0.5:
            return wanted
        return self.draw.choices([*OPERATIONS], [*OPERATIONS.values()])[0]

    def do(self, client: Client, operation: str) -> None:
        """Send an operation; record its begin and its acknowledgment in the journal.

        Raises:
            httpx.TransportError: the answer is missing; the operation may have taken effect.
            ServiceError: the service refused the operation or failed.
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
        """Return a delta that replaces, adds and removes some segments."""
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
