import numpy as np
from placecell_client import Delta, decode_delta, encode, encode_delta
from placecell_client.map_edit import apply, difference

from tests.client.map_builders import random_map


def test_a_difference_is_what_apply_needs() -> None:
    old, new = random_map(seed=1, optional=("points",)), random_map(seed=2, optional=("points",))
    changed, removed = difference(old, new)
    assert encode(apply(old, Delta(changed, removed))) == encode(new)


def test_a_delta_comes_back() -> None:
    delta = Delta(random_map(optional=("seen",)), np.array([100, 200], np.uint32), 3, 9)
    back = decode_delta(encode_delta(delta))
    assert encode_delta(back) == encode_delta(delta)
    assert (back.since, back.until, back.removed.tolist()) == (3, 9, [100, 200])
