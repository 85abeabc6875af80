"""Format of a backup: a manifest, and objects named by their SHA-256.

`backup.json` is the manifest. It lists the maps, and all objects with their sizes. Each map has a
log object in JSON: head, commits, owners of ids and annotations. The log names the objects with the
map's oldest version, and those with the commits' deltas in one sequence. A backup holds no bytes
of SQLite or PostgreSQL, so either can be restored from it.
"""

import hashlib
import json
from dataclasses import asdict, dataclass
from typing import Any, TypeVar

from pydantic import TypeAdapter, ValidationError

from service.maps.store import Annotation, Commit, MapHead, OwnedIds

FORMAT, VERSION = "placecell-backup", 1

MANIFEST = "backup.json"
"""Name of the manifest, which is written last."""

PIECE_BYTES = 32 << 20
"""Largest number of bytes of an object with a part of a map's oldest version."""

PACK_BYTES = 8 << 20
"""Number of bytes at which an object with deltas is closed."""

Parsed = TypeVar("Parsed")


class BackupError(ValueError):
    """A backup is missing, damaged, of a later version, or written by another process."""


@dataclass(frozen=True, slots=True)
class MapEntry:
    """Map in a manifest.

    Attributes:
        name: name of the map.
        uid: unique id of the map.
        sequence: sequence of its newest version.
        etag: ETag of its newest version.
        bytes: bytes of the map with its old versions.
        log: name of the log object.
    """

    name: str
    uid: str
    sequence: int
    etag: str
    bytes: int
    log: str


@dataclass(frozen=True, slots=True)
class BackupManifest:
    """Manifest of a backup.

    Attributes:
        created: time of the backup, Unix seconds.
        program: version of the program that wrote it.
        maps: maps by name.
        objects: bytes of each object, by its name.
    """

    created: float
    program: str
    maps: list[MapEntry]
    objects: dict[str, int]


@dataclass(frozen=True, slots=True)
class MapLog:
    """Log object of a map.

    Attributes:
        head: head of the map.
        commits: commits from the oldest kept version to the newest.
        base: names of the objects with the file of the oldest version, in order.
        packs: names of the objects with the deltas of all commits, in order.
        owned: runs of owned ids.
        annotations: tags, anchors and named poses.
    """

    head: MapHead
    commits: list[Commit]
    base: list[str]
    packs: list[str]
    owned: list[OwnedIds]
    annotations: list[Annotation]


_MANIFEST = TypeAdapter(BackupManifest)
_LOG = TypeAdapter(MapLog)


def name_of(data: bytes) -> str:
    """Return the name of an object: the SHA-256 of its bytes."""
    return hashlib.sha256(data).hexdigest()


def encode_manifest(manifest: BackupManifest) -> bytes:
    """Encode a manifest, with a hash of its content."""
    content = {"format": FORMAT, "version": VERSION, **asdict(manifest)}
    return json.dumps({**content, "sha256": _digest(content)}, indent=1).encode()


def decode_manifest(data: bytes, where: str) -> BackupManifest:
    """Decode a manifest.

    Args:
        data: its bytes.
        where: its place, for errors.

    Raises:
        BackupError: it is damaged, or of a later version.
    """
    try:
        content = json.loads(data)
    except ValueError as error:
        raise BackupError(f"{where} is damaged: it is no JSON. Use another backup.") from error
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise BackupError(f"{where} is no manifest of a backup of Placecell.")
    if content.get("version") != VERSION:
        raise BackupError(
            f"{where} has version {content.get('version')!r:.20} of the format; this program reads "
            f"version {VERSION}. Use the program that wrote it, or a later one."
        )
    if content.pop("sha256", None) != _digest(content):
        raise BackupError(f"{where} was altered: its hash differs. Use another backup.")
    return _parsed(_MANIFEST, data, where)


def encode_log(log: MapLog) -> bytes:
    """Encode a log object."""
    return _LOG.dump_json(log)


def decode_log(data: bytes, where: str) -> MapLog:
    """Decode a log object; BackupError if it is damaged."""
    return _parsed(_LOG, data, where)


def _digest(content: dict[str, Any]) -> str:
    return name_of(json.dumps(content, sort_keys=True).encode())


def _parsed(adapter: TypeAdapter[Parsed], data: bytes, where: str) -> Parsed:
    try:
        return adapter.validate_json(data)
    except ValidationError as error:
        first = error.errors()[0]
        field = ".".join(map(str, first["loc"]))
        raise BackupError(f"{where}: {field}: {first['msg']}. Use another backup.") from error
