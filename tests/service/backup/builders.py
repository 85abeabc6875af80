"""Stores for tests of backups, and the failures of a place."""

from collections.abc import Iterator
from dataclasses import dataclass, field

from service.backup.folder import FolderTarget
from service.maps.store import Annotation, Ids, MapHead, MapStore, Note, StoreSnapshot

NOTE = Note(1.7e9 + 1 / 3, "ann", "edit", 3, 1)
LARGE = bytes(range(256)) * 8_000


class KilledError(BaseException):
    """Stands for a process that is killed at this point."""


def fill(store: MapStore) -> MapHead:
    """Store two maps with old versions, owners, reservations and annotations; return `yard`."""
    head = store.create("yard", LARGE, NOTE, 0, Ids(((0, 9),), ((0, 9),)))
    for count in range(1, 6):
        ids = Ids(((20 * count, 20 * count + 5),), ((20 * count, 20 * count + 5),))
        head = store.append(head, bytes([count]) * count * 3_000, NOTE, 0, ids)
    head = store.compact(head.uid, 2, LARGE[::-1])
    store.reserve(head.uid, 50, "zoe")
    store.annotate(
        head.uid,
        [
            Annotation("tag", "wet", "true", "ann", 1.75e9),
            Annotation("pose", "dock", '{"position": [1, 2, 0.5]}', "zoe", 1.75e9 + 0.1),
        ],
    )
    store.create("shed", b"small", NOTE, 0, Ids(((0, 4),), ((0, 4),)))
    return next(each for each in store.heads() if each.name == "yard")


def content(source: StoreSnapshot) -> dict[str, object]:
    """Return all that a snapshot has of its maps."""
    annotations = source.annotations()
    return {
        head.name: (
            head,
            (history := source.history(head.uid)).commits(),
            history.base(),
            list(history.blobs(head.oldest, head.sequence)),
            source.owned_ids(head.uid),
            sorted(annotations.get(head.uid, ()), key=lambda row: (row.kind, row.name)),
        )
        for head in source.heads()
    }


def content_of(store: MapStore) -> dict[str, object]:
    """Return all that a store has of its maps."""
    with store.snapshot() as source:
        return content(source)


@dataclass
class Countdown:
    """Counts steps down and is killed at the last one.

    Attributes:
        steps: steps that succeed; None: all.
        done: steps so far.
    """

    steps: int | None = None
    done: int = field(default=0)

    def step(self) -> None:
        if self.done == self.steps:
            raise KilledError
        self.done += 1


class FailingFolder(FolderTarget):
    """Folder whose writer is killed after some writes."""

    countdown = Countdown()

    def write(self, name: str, data: bytes) -> None:
        self.countdown.step()
        super().write(name, data)

    def replace_manifest(self, data: bytes) -> None:
        self.countdown.step()
        super().replace_manifest(data)

    def remove_others(self, kept: object) -> None:
        self.countdown.step()
        super().remove_others(kept)  # type: ignore[arg-type]


def steps() -> Iterator[int]:
    """Yield 0, 1, 2, ... up to a bound that no test reaches."""
    yield from range(100)
