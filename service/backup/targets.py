"""Places of backups: a folder, or a prefix of an S3 bucket."""

from collections.abc import Collection
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Protocol

from service.backup.bucket import BucketTarget
from service.backup.databases import OTHER_ADDRESS
from service.backup.folder import FolderTarget
from service.backup.format import MANIFEST, BackupError, BackupManifest, decode_manifest

BUCKET = "s3://"


class BackupTarget(Protocol):
    """Place of one backup. Every write is whole or absent, and on disk when it returns."""

    def __str__(self) -> str:
        """Return the place, for messages."""

    def writing(self) -> AbstractContextManager[None]:
        """Prepare the place for a backup.

        Raises:
            BackupError: the place has other contents, or another backup to it runs.
        """

    def manifest(self) -> bytes | None:
        """Return the bytes of the manifest; None if there is none."""

    def objects(self) -> dict[str, int]:
        """Return the bytes of each object that is there, by its name."""

    def read(self, name: str) -> bytes:
        """Return an object; BackupError if it is missing."""

    def is_whole(self, name: str, data: bytes) -> bool:
        """Return whether an object that is there has these bytes, as far as that is known."""

    def write(self, name: str, data: bytes) -> None:
        """Write an object."""

    def replace_manifest(self, data: bytes) -> None:
        """Write the manifest, which makes the backup valid.

        Raises:
            BackupError: another process replaced it since `manifest` was called.
        """

    def remove_others(self, kept: Collection[str]) -> None:
        """Remove all objects but these; not those that a later backup wrote."""


def target_at(place: str, endpoint_url: str | None = None) -> BackupTarget:
    """Return the target with this name.

    Args:
        place: path of a folder, or `s3://BUCKET/PREFIX`.
        endpoint_url: address of a service that speaks S3; None: Amazon's, or the one that
            `AWS_ENDPOINT_URL` names.

    Raises:
        ValueError: the name is not valid.
        BackupError: the extra `s3` is not installed.
    """
    if not place.startswith(BUCKET):
        if not place.strip() or OTHER_ADDRESS.match(place):
            told = place.rpartition("@")[2]  # it may hold a password
            raise ValueError(f"Invalid place {told!r}: expected a folder or s3://BUCKET/PREFIX.")
        return FolderTarget(Path(place))
    bucket, _, prefix = place.removeprefix(BUCKET).partition("/")
    if not bucket:
        raise ValueError(f"Invalid place {place!r}: expected s3://BUCKET/PREFIX.")
    return BucketTarget(bucket, prefix.strip("/"), endpoint_url)


def manifest_of(target: BackupTarget) -> BackupManifest | None:
    """Return the manifest of a target; None if it has none, BackupError if it is damaged."""
    data = target.manifest()
    return None if data is None else decode_manifest(data, f"{target}/{MANIFEST}")


def existing_manifest_of(target: BackupTarget) -> BackupManifest:
    """Return the manifest of a backup; BackupError if there is none, or if it is damaged."""
    manifest = manifest_of(target)
    if manifest is None:
        raise BackupError(
            f"{target} holds no backup: {MANIFEST} is missing. Name the folder or the prefix that "
            "'placecell backup' wrote."
        )
    return manifest
