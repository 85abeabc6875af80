"""Names of maps in a path."""

import re
from typing import Annotated, Any

from fastapi import Depends, Path

from service.core.problems import Problem
from service.maps.store import NAME_PATTERN

NAME_RULE = "1 to 64 letters, digits, dots, dashes, underscores; a letter or digit first"


def _path(alias: str, what: str, example: str) -> Any:
    return Path(
        alias=alias,
        description=f"{what}: {NAME_RULE}.",
        json_schema_extra={"pattern": NAME_PATTERN},
        examples=[example],
    )


async def checked_name(name: Annotated[str, _path("map", "The map's name", "yard")]) -> str:
    """The map's name in the path; 422 if none can be named so."""
    return checked(name)


async def checked_other(name: Annotated[str, _path("other", "Another's name", "hall")]) -> str:
    """Another map's name in the path; 422 if none can be named so."""
    return checked(name)


def checked(name: str) -> str:
    """The name; 422 if no map can be named so."""
    if not re.fullmatch(NAME_PATTERN, name):
        raise Problem(422, "invalid-map-name", f"{name!r:.200} is no map's name: {NAME_RULE}.")
    return name


Name = Annotated[str, Depends(checked_name)]
OtherName = Annotated[str, Depends(checked_other)]
