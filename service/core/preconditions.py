"""Preconditions If-Match and If-None-Match (RFC 9110, 13.1): bind a request to a version."""

from dataclasses import dataclass

from service.core.problems import Problem


@dataclass(frozen=True, slots=True)
class Preconditions:
    """Precondition headers of a request.

    Attributes:
        if_match: value of If-Match; None if the request has none.
        if_none_match: value of If-None-Match; None if the request has none.
    """

    if_match: str | None = None
    if_none_match: str | None = None

    def check(self, tag: str | None) -> None:
        """Check that the preconditions hold.

        Args:
            tag: tag of the map's newest version; None if there is no such map.

        Raises:
            Problem: 412 if a precondition fails.
        """
        if self.if_match is not None and not self._matches(tag):
            raise self._failed(tag, "If-Match", self.if_match)
        if self.is_known(tag):
            raise self._failed(tag, "If-None-Match", self.if_none_match)

    def check_replaces(self, tag: str) -> None:
        """Check the preconditions of a write that replaces content; 428 if If-Match is missing."""
        self.check(tag)
        if self.if_match is None:
            raise Problem(
                428,
                "precondition-required",
                "The map exists and has other content. To replace it, send If-Match with the ETag "
                f'of the version to replace (the newest is "{tag}"), or * for any version.',
                headers={"ETag": f'"{tag}"'},
            )

    def is_known(self, tag: str | None) -> bool:
        """Return whether If-None-Match names the map's newest version."""
        if self.if_none_match is None or tag is None:
            return False
        # RFC 9110 asks for weak comparison here.
        return bool({*_tags(self.if_none_match, weak=True)} & {"*", f'"{tag}"'})

    def _matches(self, tag: str | None) -> bool:
        assert self.if_match is not None
        return tag is not None and bool({*_tags(self.if_match)} & {"*", f'"{tag}"'})

    def _failed(self, tag: str | None, header: str, value: str | None) -> Problem:
        if tag is None:
            found, headers = "The map does not exist", None
        else:
            found, headers = f'The map is at version "{tag}"', {"ETag": f'"{tag}"'}
        detail = f"{found}, but the request has {header}: {value:.200}. Read the map and try again."
        return Problem(412, "precondition-failed", detail, headers=headers)


def _tags(header: str, weak: bool = False) -> list[str]:
    tags = [tag.strip() for tag in header.split(",")]
    return [tag.removeprefix("W/") for tag in tags] if weak else tags
