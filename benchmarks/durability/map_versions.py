"""What a map was and is: the versions that a service must have of it, and those that it has."""

from dataclasses import dataclass, field, replace

from placecell_client import Client, ServiceError


@dataclass(frozen=True, slots=True)
class MapVersion:
    """One version of a map.

    Attributes:
        sequence: of it.
        file: the map's, whole.
        tag: that the service gave it; None as long as it was not told.
    """

    sequence: int
    file: bytes = field(repr=False)
    tag: str | None = None

    def is_version(self, found: "MapVersion") -> bool:
        """Whether what was found is this version."""
        told = self.tag is None or self.tag == found.tag
        return told and (self.sequence, self.file) == (found.sequence, found.file)


@dataclass(frozen=True, slots=True)
class VersionHistory:
    """The versions of a map that are kept, oldest first, one at least."""

    versions: tuple[MapVersion, ...]

    @classmethod
    def begun(cls, file: bytes) -> "VersionHistory":
        """Of a new map."""
        return cls((MapVersion(1, file),))

    @property
    def newest(self) -> MapVersion:
        """The map as it is."""
        return self.versions[-1]

    def after(self, file: bytes) -> "VersionHistory":
        """With another version; the same if it would be no other."""
        if file == self.newest.file:
            return self
        return VersionHistory((*self.versions, MapVersion(self.newest.sequence + 1, file)))

    def shortened(self, keep: int) -> "VersionHistory":
        """With the last versions only."""
        return VersionHistory(self.versions[-keep:])

    def told(self, tag: str) -> "VersionHistory":
        """With the tag of the newest version."""
        return VersionHistory((*self.versions[:-1], replace(self.newest, tag=tag)))

    def is_past(self, found: "VersionHistory | None") -> bool:
        """Whether what was found is this, version by version."""
        return (
            found is not None
            and len(found.versions) == len(self.versions)
            and all(map(MapVersion.is_version, self.versions, found.versions))
        )


def history_of(client: Client, name: str) -> VersionHistory | None:
    """All versions that a service has of a map; None if it has no such map."""
    try:
        listed = client.versions(name)
    except ServiceError as error:
        if error.status == 404:
            return None
        raise
    return VersionHistory(
        tuple(
            MapVersion(each.sequence, client.get_map_file(name, version=each.sequence), each.etag)
            for each in reversed(listed)
        )
    )
