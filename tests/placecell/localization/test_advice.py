"""Advice to a robot that is not localized."""

from dataclasses import replace

import numpy as np
import pytest

from placecell.localization import localize
from placecell.localization.advice import FARTHEST, advice_of
from placecell.localization.confidence import SegmentNeeds, shipped
from tests.placecell.localization.scene_builders import scene, take
from tests.placecell.localization.test_localize import look_alikes

FEW = replace(shipped(), needs=SegmentNeeds(segments=15, per_meter=2.0))
"""Needs 15 segments; a robot that starts to drive sees two more per meter."""


def test_localized_robot_gets_no_advice() -> None:
    advice = advice_of(localize(scene(1).candidates))
    assert (advice.text, advice.meters) == ("", None)


@pytest.mark.parametrize(("segments", "meters"), [(3, 6.0), (2, 7.0)])
def test_few_segments_say_how_far_to_drive(segments: int, meters: float) -> None:
    few = take(scene(1).candidates, np.arange(segments))
    found = localize(few, confidence=FEW)
    assert found.reason == "too-few-segments"
    advice = advice_of(found)
    assert advice.meters == meters  # (15 - segments) / 2, rounded up
    assert f"Drive about {meters:.0f} m." in advice.text
    assert "15 or more" in advice.text


def test_distance_is_bounded() -> None:
    found = localize(take(scene(1).candidates, np.arange(2)))
    hardly = replace(found, needs=SegmentNeeds(15, 0.01))
    assert advice_of(hardly).meters == FARTHEST


def test_enough_segments_without_a_match_ask_for_the_frame_and_the_area() -> None:
    advice = advice_of(localize(scene(3, found=0.0).candidates))
    assert advice.meters is None
    assert "the map covers this area" in advice.text
    assert "sensor's height" in advice.text


def test_ambiguous_place_asks_for_a_session() -> None:
    found = localize(look_alikes(2, 60.0, turned=False).candidates)
    assert found.reason == "ambiguous"
    assert "'session'" in advice_of(found).text
    assert "m apart" in found.detail
