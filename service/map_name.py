"""A map's name in a path."""

import re
from typing import Annotated

from fastapi import Depends, Path

from service.map_store import NAME_PATTERN
from service.problems import Problem

NAME_RULE = "1 to 64 letters, digits, dots, dashes, underscores; a letter or digit first"


async def checked_name(
    name: Annotated[
        str,
        Path(
            alias="map",
            description=f"The map's name: {NAME_RULE}.",
            json_schema_extra={"pattern": NAME_PATTERN},
            examples=["yard"],
        ),
    ],
) -> str:
    """The map's name in the path; 422 if none can be named so."""
    if not re.fullmatch(NAME_PATTERN, name):
        raise Problem(422, "invalid-map-name", f"{name!r:.200} is no map's name: {NAME_RULE}.")
    return name


Name = Annotated[str, Depends(checked_name)]
