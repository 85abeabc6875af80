"""Writes a backup: new objects first, the manifest last, then removes what no backup needs."""

from collections.abc import Iterable, Iterator

from service.backup.format import (
    PACK_BYTES,
    PIECE_BYTES,
    BackupError,
    BackupManifest,
    MapEntry,
    MapLog,
    encode_log,
    encode_manifest,
    name_of,
)
from service.backup.targets import BackupTarget, manifest_of
from service.maps.snapshot import tag_of
from service.maps.store import Annotation, MapHead, StoreSnapshot


class BackupWriter:
    """Writer of one backup.

    Attributes:
        new_bytes: bytes of objects that the previous backup in the same place did not have.
    """

    def __init__(self, target: BackupTarget) -> None:
        self.new_bytes = 0
        self._target = target
        self._objects: dict[str, int] = {}
        self._reused: set[str] = set()

    def write(self, source: StoreSnapshot, program: str, now: float) -> BackupManifest:
        """Write a backup of all maps. If it is interrupted, the previous backup stays.

        Args:
            source: the maps.
            program: version of this program.
            now: present time, Unix seconds.

        Raises:
            BackupError: the place cannot be used, or an empty store would replace a backup.
            StoreError: a map is damaged.
            OSError: the place cannot be written.
        """
        with self._target.writing():
            try:
                before = manifest_of(self._target)
            except BackupError as error:
                raise BackupError(f"{error} A new backup needs a new target.") from error
            if before:
                present = self._target.objects()
                self._reused = {
                    name for name, size in before.objects.items() if present.get(name) == size
                }
            heads, annotations = source.heads(), source.annotations()
            if before and before.maps and not heads:
                raise BackupError(
                    f"The store has no maps, but the backup in {self._target} has "
                    f"{len(before.maps)}. Name the right store, or a new target."
                )
            maps = [self._map(source, head, annotations.get(head.uid, [])) for head in heads]
            manifest = BackupManifest(now, program, maps, self._objects)
            self._target.replace_manifest(encode_manifest(manifest))
            self._target.remove_others(self._objects.keys())
            return manifest

    def _map(self, source: StoreSnapshot, head: MapHead, annotations: list[Annotation]) -> MapEntry:
        history = source.history(head.uid)
        blobs = (blob for _, blob in history.blobs(head.oldest, head.sequence))
        log = MapLog(
            head=head,
            commits=history.commits(),
            base=self._written(pieces_of(history.base())),
            packs=self._written(packs_of(blobs)),
            owned=source.owned_ids(head.uid),
            annotations=annotations,
        )
        (name,) = self._written([encode_log(log)])
        tag = tag_of(head.sequence, head.mark)
        return MapEntry(head.name, head.uid, head.sequence, tag, head.bytes, name)

    def _written(self, objects: Iterable[bytes]) -> list[str]:
        names = []
        for data in objects:
            name = name_of(data)
            names.append(name)
            is_there = name in self._objects or (
                name in self._reused and self._target.is_whole(name, data)
            )
            if not is_there:
                self._target.write(name, data)
                self.new_bytes += len(data)
            self._objects[name] = len(data)
        return names


def pieces_of(data: bytes, size: int = PIECE_BYTES) -> Iterator[bytes]:
    """Cut bytes into pieces of a size; the last may be shorter."""
    for start in range(0, len(data), size):
        yield data[start : start + size]


def packs_of(blobs: Iterable[bytes], size: int = PACK_BYTES) -> Iterator[bytes]:
    """Join blobs into packs; later blobs never change a full pack, so backups can reuse it."""
    pack: list[bytes] = []
    filled = 0
    for blob in blobs:
        pack.append(blob)
        filled += len(blob)
        if filled >= size:
            yield b"".join(pack)
            pack, filled = [], 0
    if pack:
        yield b"".join(pack)
