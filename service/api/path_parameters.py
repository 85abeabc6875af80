"""Path parameters: names of maps."""

import re
from typing import Annotated, Any

from fastapi import Depends, Path

from service.core.problems import Problem
from service.maps.store import NAME_PATTERN

NAME_RULE = "1 to 64 letters, digits, dots, dashes or underscores, beginning with a letter or digit"


def _path(alias: str, what: str, example: str) -> Any:
    return Path(
        alias=alias,
        description=f"{what}: {NAME_RULE}.",
        json_schema_extra={"pattern": NAME_PATTERN},
        examples=[example],
    )


async def checked_name(name: Annotated[str, _path("map", "Name of the map", "yard")]) -> str:
    """Return the map's name in the path; 422 if it is not a valid name."""
    return checked(name)


async def checked_other(
    name: Annotated[str, _path("other", "Name of the other map", "hall")],
) -> str:
    """Return the other map's name in the path; 422 if it is not a valid name."""
    return checked(name)


def checked(name: str) -> str:
    """Return a name; 422 if it is not a valid name of a map."""
    if not re.fullmatch(NAME_PATTERN, name):
        raise Problem(
            422, "invalid-map-name", f"Invalid map name {name!r:.200}: expected {NAME_RULE}."
        )
    return name


async def checked_robot(
    robot: Annotated[str, _path("robot", "Name of the robot", "ann")],
) -> str:
    """Return the robot's name in the path; 422 if it is not a valid name."""
    return _checked_name(robot, "robot")


async def checked_anchor(
    anchor: Annotated[str, _path("anchor", "Name of the anchor", "dock")],
) -> str:
    """Return the anchor's name in the path; 422 if it is not a valid name."""
    return _checked_name(anchor, "anchor")


def _checked_name(name: str, what: str) -> str:
    if not re.fullmatch(NAME_PATTERN, name):
        raise Problem(
            422, "invalid-name", f"Invalid {what} name {name!r:.200}: expected {NAME_RULE}."
        )
    return name


Name = Annotated[str, Depends(checked_name)]
AnchorName = Annotated[str, Depends(checked_anchor)]
RobotName = Annotated[str, Depends(checked_robot)]
OtherName = Annotated[str, Depends(checked_other)]
