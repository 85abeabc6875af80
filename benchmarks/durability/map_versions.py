"""Versions of a map: those that a service must have, and those that it has."""

from dataclasses import dataclass, field, replace

from placecell_client import Client, ServiceError


@dataclass(frozen=True, slots=True)
class VersionFile:
    """One version of a map.

    Attributes:
        sequence: number of the version.
        file: map file of the version.
        tag: ETag of the version; None if unknown.
    """

    sequence: int
    file: bytes = field(repr=False)
    tag: str | None = None

    def is_version(self, found: "VersionFile") -> bool:
        """Return whether a found version is this one."""
        is_tagged = self.tag is None or self.tag == found.tag
        return is_tagged and (self.sequence, self.file) == (found.sequence, found.file)


@dataclass(frozen=True, slots=True)
class VersionHistory:
    """Available versions of a map, oldest first; at least one."""

    versions: tuple[VersionFile, ...]

    @classmethod
    def begun(cls, file: bytes) -> "VersionHistory":
        """Return the history of a new map."""
        return cls((VersionFile(1, file),))

    @property
    def newest(self) -> VersionFile:
        """Return the newest version."""
        return self.versions[-1]

    def after(self, file: bytes) -> "VersionHistory":
        """Return the history with another version; the same history if the file is unchanged."""
        if file == self.newest.file:
            return self
        return VersionHistory((*self.versions, VersionFile(self.newest.sequence + 1, file)))

    def shortened(self, keep: int) -> "VersionHistory":
        """Return the history with its last `keep` versions only."""
        return VersionHistory(self.versions[-keep:])

    def tagged(self, tag: str) -> "VersionHistory":
        """Return the history with the ETag of the newest version."""
        return VersionHistory((*self.versions[:-1], replace(self.newest, tag=tag)))

    def is_past(self, found: "VersionHistory | None") -> bool:
        """Return whether a found history has exactly these versions."""
        return (
            found is not None
            and len(found.versions) == len(self.versions)
            and all(map(VersionFile.is_version, self.versions, found.versions))
        )


def history_of(client: Client, name: str) -> VersionHistory | None:
    """Download all versions of a map; return None if the service has no such map."""
    try:
        listed = client.versions(name)
    except ServiceError as error:
        if error.status == 404:
            return None
        raise
    return VersionHistory(
        tuple(
            VersionFile(each.sequence, client.get_map_file(name, version=each.sequence), each.etag)
            for each in reversed(listed)
        )
    )
