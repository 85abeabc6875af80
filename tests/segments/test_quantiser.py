import numpy as np
import pytest

from segments.quantiser import Quantiser


def test_codes_by_hand() -> None:
    codes = Quantiser(step=0.5).encode(np.array([[0, 0.5, -1.0, 0.74, 0.76, -0.2]], np.float32))
    assert codes.dtype == np.int8
    assert codes.tolist() == [[0, 1, -2, 1, 2, 0]]
    decoded = Quantiser(step=0.5).decode(codes)
    assert decoded.dtype == np.float32
    assert decoded.tolist() == [[0, 0.5, -1.0, 0.5, 1.0, 0]]


def test_values_beyond_reach_saturate_alike_on_both_sides() -> None:
    codes = Quantiser(step=0.01).encode(
        np.array([[1.27, 1.28, 9e9, -1.27, -1.28, -9e9]], np.float32)
    )
    assert codes.tolist() == [[127, 127, 127, -127, -127, -127]]


def test_fit_reaches_the_largest_value_seen() -> None:
    descriptors = np.array([[0.1, -6.35], [2.0, 0.3]], np.float32)
    assert Quantiser.fit(descriptors, quantile=1.0).step == pytest.approx(6.35 / 127)


def test_fit_lets_rare_outliers_saturate() -> None:
    descriptors = np.linspace(-1, 1, 100_000, dtype=np.float32)[:, None]
    descriptors[:10] = 1000.0
    assert Quantiser.fit(descriptors).step == pytest.approx(1 / 127, rel=1e-2)


def test_fit_of_zeros_still_has_a_step() -> None:
    quantiser = Quantiser.fit(np.zeros((5, 3), np.float32))
    assert quantiser.step > 0
    assert not quantiser.encode(np.zeros((5, 3), np.float32)).any()


def test_round_trip_is_off_by_half_a_step_at_most() -> None:
    descriptors = np.random.default_rng(0).normal(size=(200, 32)).astype(np.float32)
    quantiser = Quantiser.fit(descriptors, quantile=1.0)
    off = np.abs(quantiser.decode(quantiser.encode(descriptors)) - descriptors)
    assert off.max() <= quantiser.step / 2 + 1e-6


def test_stored_descriptors_do_not_change_when_stored_again() -> None:
    codes = np.arange(-127, 128, dtype=np.int8)[None]
    quantiser = Quantiser(step=0.0371)
    assert np.array_equal(quantiser.encode(quantiser.decode(codes)), codes)


def test_distances_between_codes_are_distances() -> None:
    quantiser = Quantiser(step=0.25)
    codes = np.array([[3, -4], [0, 0]], dtype=np.int8)
    a, b = quantiser.decode(codes)
    assert float(np.linalg.norm(a - b)) == 5 * 0.25


def test_two_levels_of_four_bits_share_a_byte() -> None:
    quantiser = Quantiser(step=0.5, bits=4)
    codes = quantiser.encode(np.array([[0.5, -1.0, 9.0, -9.0]], np.float32))
    assert codes.shape == (1, quantiser.code_bytes(4)) == (1, 2)
    # 1 below, -2 = 0xe above; 7 below, -7 = 0x9 above.
    assert codes.view(np.uint8).tolist() == [[0xE1, 0x97]]
    assert quantiser.levels(codes).tolist() == [[1, -2, 7, -7]]
    assert quantiser.decode(codes).tolist() == [[0.5, -1.0, 3.5, -3.5]]


def test_four_bits_round_trip_all_levels() -> None:
    levels = np.stack(np.meshgrid(np.arange(-7, 8), np.arange(-7, 8)), axis=-1).reshape(-1, 2)
    quantiser = Quantiser(step=1.0, bits=4)
    assert (quantiser.levels(quantiser.encode(levels.astype(np.float32))) == levels).all()


def test_no_other_bits() -> None:
    with pytest.raises(ValueError, match="3 bits"):
        Quantiser(step=1.0, bits=3)


def test_manifests_of_bytes_say_what_they_always_said() -> None:
    assert Quantiser(0.5).as_dict() == {"step": 0.5}
    assert Quantiser(**Quantiser(0.5, 4).as_dict()) == Quantiser(0.5, 4)  # type: ignore[arg-type]
