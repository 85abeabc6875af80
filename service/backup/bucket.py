"""Backup in an S3 bucket: Amazon's, MinIO, and other services that speak S3."""

from collections.abc import Collection, Iterator
from contextlib import contextmanager
from typing import Any

from service.backup.format import MANIFEST, BackupError

CONNECT_SECONDS, READ_SECONDS = 10, 60
ATTEMPTS = 5

BATCH = 1_000
"""Largest number of objects that S3 deletes in one request."""

REPLACED = {"PreconditionFailed", "ConditionalRequestConflict", "412", "409"}
"""Error codes of a manifest that another process has replaced."""


class BucketTarget:
    """Prefix of a bucket with a backup: `PREFIX/backup.json`, and `PREFIX/objects/ABCDEF...`."""

    def __init__(self, bucket: str, prefix: str, endpoint_url: str | None) -> None:
        """Create a client; it connects at the first call.

        Credentials and region come from the usual places of boto3, such as `AWS_ACCESS_KEY_ID`.

        Raises:
            BackupError: the extra `s3` is not installed.
        """
        try:
            import boto3
            from botocore.config import Config
        except ModuleNotFoundError as error:
            raise BackupError(
                "Backups in S3 need the extra 's3': pip install 'placecell[s3]'."
            ) from error
        self._bucket = bucket
        self._prefix = f"{prefix}/" if prefix else ""
        self._client = boto3.client(
            "s3",
            endpoint_url=endpoint_url,
            config=Config(
                connect_timeout=CONNECT_SECONDS,
                read_timeout=READ_SECONDS,
                retries={"mode": "standard", "max_attempts": ATTEMPTS},
                # Other services than Amazon's do not know the newer checksums.
                request_checksum_calculation="when_required",
                response_checksum_validation="when_required",
            ),
        )
        self._found: str | None = None

    def __str__(self) -> str:
        return f"s3://{self._bucket}/{self._prefix}".rstrip("/")

    @contextmanager
    def writing(self) -> Iterator[None]:
        """Do nothing: the manifest is replaced only if no other process replaced it."""
        yield

    def manifest(self) -> bytes | None:
        """Return the bytes of the manifest; None if there is none."""
        with self._told():
            found = self._get(MANIFEST)
        self._found = found["ETag"] if found else None
        return found["Body"] if found else None

    def objects(self) -> dict[str, int]:
        """Return the bytes of each object that is there, by its name."""
        return {each["Name"]: each["Size"] for each in self._listed()}

    def read(self, name: str) -> bytes:
        """Return an object; BackupError if it is missing."""
        with self._told():
            found = self._get(f"objects/{name}")
        if found is None:
            raise BackupError(f"{self}/objects/{name} is missing. Use another backup.")
        data: bytes = found["Body"]
        return data

    def is_whole(self, name: str, data: bytes) -> bool:
        """Return True: the service checks and repairs its objects itself."""
        del name, data
        return True

    def write(self, name: str, data: bytes) -> None:
        """Write an object."""
        with self._told():
            self._put(f"objects/{name}", data)

    def replace_manifest(self, data: bytes) -> None:
        """Write the manifest, unless another process wrote one since `manifest` was called."""
        from botocore.exceptions import ClientError

        condition = {"IfMatch": self._found} if self._found else {"IfNoneMatch": "*"}
        with self._told():
            try:
                self._put(MANIFEST, data, **condition)
            except ClientError as error:
                code = error.response["Error"]["Code"]
                if code in REPLACED:
                    raise BackupError(
                        f"Another backup to {self} ended in the meantime, and it stays. Run one "
                        "backup at a time, or give each its own prefix."
                    ) from error
                if code != "NotImplemented":
                    raise
                # This service knows no conditions.
                self._put(MANIFEST, data)

    def remove_others(self, kept: Collection[str]) -> None:
        """Remove all objects but these that are older than the manifest."""
        with self._told():
            manifest = self._client.head_object(
                Bucket=self._bucket, Key=f"{self._prefix}{MANIFEST}"
            )
            # Another backup that began in the meantime may have written the later ones.
            unused = [
                {"Key": each["Key"]}
                for each in self._listed()
                if each["Name"] not in kept and each["LastModified"] < manifest["LastModified"]
            ]
            for start in range(0, len(unused), BATCH):
                self._client.delete_objects(
                    Bucket=self._bucket,
                    Delete={"Objects": unused[start : start + BATCH], "Quiet": True},
                )

    def _listed(self) -> list[dict[str, Any]]:
        prefix = f"{self._prefix}objects/"
        with self._told():
            pages = self._client.get_paginator("list_objects_v2").paginate(
                Bucket=self._bucket, Prefix=prefix
            )
            return [
                {**each, "Name": each["Key"].removeprefix(prefix)}
                for page in pages
                for each in page.get("Contents", ())
            ]

    def _get(self, name: str) -> dict[str, Any] | None:
        try:
            found = self._client.get_object(Bucket=self._bucket, Key=f"{self._prefix}{name}")
        except self._client.exceptions.NoSuchKey:
            return None
        return {**found, "Body": found["Body"].read()}

    def _put(self, name: str, data: bytes, **condition: str | None) -> None:
        self._client.put_object(
            Bucket=self._bucket, Key=f"{self._prefix}{name}", Body=data, **condition
        )

    @contextmanager
    def _told(self) -> Iterator[None]:
        """Translate errors of S3 into an OSError that names the place."""
        from botocore.exceptions import BotoCoreError, ClientError, HTTPClientError

        try:
            yield
        except (BotoCoreError, ClientError, HTTPClientError) as error:
            raise OSError(f"{self}: {error}") from error
