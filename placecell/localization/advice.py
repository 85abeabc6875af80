"""Advice: what helps a robot that is not localized."""

from dataclasses import dataclass
from math import ceil

from placecell.localization.localize import Localization

SESSION = "Send the requests with one 'session', so that they support each other."

FARTHEST = 50.0
"""Largest distance that the advice names, meters."""


@dataclass(frozen=True, slots=True)
class Advice:
    """Instructions for a robot that is not localized.

    Attributes:
        text: instructions; empty if the robot is localized.
        meters: distance after which enough segments are seen, meters; None if the number of
            segments is not the problem.
    """

    text: str
    meters: float | None


def advice_of(found: Localization) -> Advice:
    """Return what helps, from the reason and from the segments that a sure pose usually needs."""
    if found.reason is None:
        return Advice("", None)
    missing = found.needs.segments - found.usable
    meters = None
    drive = "Drive on."
    if missing > 0:
        meters = float(min(ceil(missing / found.needs.per_meter), FARTHEST))
        drive = (
            f"{found.usable} segments have candidates in the map; a sure pose usually needs "
            f"{found.needs.segments} or more. Drive about {meters:.0f} m."
        )
    if found.reason == "too-few-segments":
        return Advice(
            f"{drive} {SESSION} If the sensor sees much more than this, check that the map has "
            "segments and that the segmentation has the right height of the ground.",
            meters,
        )
    if found.reason == "ambiguous":
        return Advice(f"{drive} {SESSION} 'places' has both places.", meters)
    if found.reason == "outside-hints":
        return Advice(
            "Check the hints, widen them, or send the request without them. If the hints are "
            f"right: {drive[0].lower()}{drive[1:]} {SESSION}",
            meters,
        )
    if found.best is not None:
        return Advice(
            f"{drive} {SESSION} A larger 'max_false_acceptance' lowers the threshold.", meters
        )
    return Advice(
        f"{drive} {SESSION} If this does not help, check that the map covers this area, that z "
        "is up in the robot's frame, that coordinates are in meters, and that the sensor's height "
        "and tilt are right.",
        meters,
    )
