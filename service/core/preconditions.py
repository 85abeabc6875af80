"""If-Match and If-None-Match (RFC 9110, 13.1): a write for one version is not done to another."""

from dataclasses import dataclass

from service.core.problems import Problem


@dataclass(frozen=True, slots=True)
class Preconditions:
    """The two headers of a request, as they came."""

    if_match: str | None = None
    if_none_match: str | None = None

    def check(self, tag: str | None) -> None:
        """See that they hold.

        Args:
            tag: of the map as it is; None if there is none.

        Raises:
            Problem: 412 if they do not.
        """
        if self.if_match is not None and not self._matches(tag):
            raise self._failed(tag, "If-Match")
        if self.is_known(tag):
            raise self._failed(tag, "If-None-Match")

    def check_replaces(self, tag: str) -> None:
        """The same, and that the client says what it replaces; 428 if it does not."""
        self.check(tag)
        if self.if_match is None:
            raise Problem(
                428,
                "precondition-required",
                'There is such a map, with other content. To replace it say If-Match: "ETAG" of '
                "the version that you have seen, or * for any.",
                headers={"ETag": f'"{tag}"'},
            )

    def is_known(self, tag: str | None) -> bool:
        """Whether If-None-Match names the map as it is."""
        if self.if_none_match is None or tag is None:
            return False
        # Weak comparison, as is due here.
        return bool({*_tags(self.if_none_match, weak=True)} & {"*", f'"{tag}"'})

    def _matches(self, tag: str | None) -> bool:
        assert self.if_match is not None
        return tag is not None and bool({*_tags(self.if_match)} & {"*", f'"{tag}"'})

    def _failed(self, tag: str | None, header: str) -> Problem:
        now = f'is at version "{tag}"' if tag is not None else "is not there"
        headers = {"ETag": f'"{tag}"'} if tag is not None else None
        return Problem(
            412, "precondition-failed", f"The map {now}, which {header} rules out.", headers=headers
        )


def _tags(header: str, weak: bool = False) -> list[str]:
    tags = [tag.strip() for tag in header.split(",")]
    return [tag.removeprefix("W/") for tag in tags] if weak else tags
