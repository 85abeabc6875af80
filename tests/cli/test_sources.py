"""Names of simulated drives."""

import pytest

from cli.sources import parse_town


@pytest.mark.parametrize(
    ("text", "parsed"),
    [
        ("town:7", (7, "hdl-64e", "streets")),
        ("town:11:vlp-16", (11, "vlp-16", "streets")),
        ("town:0:os0-128:campus", (0, "os0-128", "campus")),
    ],
)
def test_town_names_seed_sensor_and_place(text: str, parsed: tuple[int, str, str]) -> None:
    assert parse_town(text) == parsed


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("town:x", "expected town:SEED, town:SEED:SENSOR or town:SEED:SENSOR:PLACE"),
        ("town:1:", "expected town:SEED"),
        ("town:1:vlp-16:campus:x", "expected town:SEED"),
        ("town:1:vlp16", "Unknown sensor 'vlp16': expected one of hdl-64e, hdl-32e, vlp-16"),
        ("town:1:vlp-16:moon", "'moon': expected one of streets, campus"),
    ],
)
def test_wrong_town_is_refused(text: str, said: str) -> None:
    with pytest.raises(ValueError, match=said):
        parse_town(text)
