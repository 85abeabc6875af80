import numpy as np
import pytest

from placecell.descriptors.quantizer import Quantizer


def test_codes_by_hand() -> None:
    codes = Quantizer(step=0.5).encode(np.array([[0, 0.5, -1.0, 0.74, 0.76, -0.2]], np.float32))
    assert codes.dtype == np.int8
    assert codes.tolist() == [[0, 1, -2, 1, 2, 0]]
    decoded = Quantizer(step=0.5).decode(codes)
    assert decoded.dtype == np.float32
    assert decoded.tolist() == [[0, 0.5, -1.0, 0.5, 1.0, 0]]


def test_values_beyond_reach_saturate_alike_on_both_sides() -> None:
    codes = Quantizer(step=0.01).encode(
        np.array([[1.27, 1.28, 9e9, -1.27, -1.28, -9e9]], np.float32)
    )
    assert codes.tolist() == [[127, 127, 127, -127, -127, -127]]


def test_fit_reaches_the_largest_value_seen() -> None:
    descriptors = np.array([[0.1, -6.35], [2.0, 0.3]], np.float32)
    assert Quantizer.fit(descriptors, quantile=1.0).step == pytest.approx(6.35 / 127)


def test_fit_lets_rare_outliers_saturate() -> None:
    descriptors = np.linspace(-1, 1, 100_000, dtype=np.float32)[:, None]
    descriptors[:10] = 1000.0
    assert Quantizer.fit(descriptors).step == pytest.approx(1 / 127, rel=1e-2)


def test_fit_of_zeros_still_has_a_step() -> None:
    quantizer = Quantizer.fit(np.zeros((5, 3), np.float32))
    assert quantizer.step > 0
    assert not quantizer.encode(np.zeros((5, 3), np.float32)).any()


def test_round_trip_is_off_by_half_a_step_at_most() -> None:
    descriptors = np.random.default_rng(0).normal(size=(200, 32)).astype(np.float32)
    quantizer = Quantizer.fit(descriptors, quantile=1.0)
    off = np.abs(quantizer.decode(quantizer.encode(descriptors)) - descriptors)
    assert off.max() <= quantizer.step / 2 + 1e-6


def test_stored_descriptors_do_not_change_when_stored_again() -> None:
    codes = np.arange(-127, 128, dtype=np.int8)[None]
    quantizer = Quantizer(step=0.0371)
    assert np.array_equal(quantizer.encode(quantizer.decode(codes)), codes)


def test_distances_between_codes_are_distances() -> None:
    quantizer = Quantizer(step=0.25)
    codes = np.array([[3, -4], [0, 0]], dtype=np.int8)
    a, b = quantizer.decode(codes)
    assert float(np.linalg.norm(a - b)) == 5 * 0.25


def test_two_dimensions_share_a_byte() -> None:
    quantizer = Quantizer(step=0.5, per_byte=2)
    codes = quantizer.encode(np.array([[0.5, -1.0, 9.0, -9.0]], np.float32))
    assert codes.shape == (1, quantizer.code_bytes(4)) == (1, 2)
    # Levels 1 and -2 are the digits 8 and 5 of 15: 8 + 5 * 15 - 112; 7 and -7 are 14 and 0.
    assert codes.tolist() == [[-29, -98]]
    assert quantizer.levels(codes).tolist() == [[1, -2, 7, -7]]
    assert quantizer.decode(codes).tolist() == [[0.5, -1.0, 3.5, -3.5]]


def test_three_dimensions_share_a_byte() -> None:
    quantizer = Quantizer(step=0.5, per_byte=3)
    codes = quantizer.encode(np.array([[0.1, -0.1, 1.1, 9.0, -9.0, -1.9]], np.float32))
    # Levels 1, -1, 3 are the digits 3, 2, 4 of 6: 3 + 2 * 6 + 4 * 36 - 108; then 5, 0, 1.
    assert codes.tolist() == [[51, -67]]
    assert quantizer.levels(codes).tolist() == [[1, -1, 3, 5, -5, -3]]
    assert quantizer.decode(codes).tolist() == [[0.5, -0.5, 1.5, 2.5, -2.5, -1.5]]


@pytest.mark.parametrize("per_byte", [1, 2, 3, 4])
def test_every_code_in_use_has_its_own_levels(per_byte: int) -> None:
    quantizer = Quantizer(step=1.0, per_byte=per_byte)
    some = np.arange(-quantizer.highest, quantizer.highest + 1, quantizer.spacing)
    levels = np.stack(np.meshgrid(*[some] * per_byte), axis=-1).reshape(-1, per_byte)
    codes = quantizer.encode(levels.astype(np.float32))
    assert len(np.unique(codes)) == len(levels) <= 256
    assert (quantizer.levels(codes) == levels).all()


@pytest.mark.parametrize("per_byte", [1, 2, 3, 4])
def test_any_byte_decodes_to_a_level(per_byte: int) -> None:
    quantizer = Quantizer(step=1.0, per_byte=per_byte)
    levels = quantizer.levels(np.arange(256, dtype=np.uint8).view(np.int8)[None])
    assert np.abs(levels.astype(int)).max() <= quantizer.highest


def test_four_dimensions_share_a_byte() -> None:
    quantizer = Quantizer(step=0.5, per_byte=4)
    codes = quantizer.encode(np.array([[0.1, -0.1, 9.0, -9.0]], np.float32))
    # Levels 1, -1, 3, -3 are the digits 2, 1, 3, 0 of 4: two bits each, 54, less 128.
    assert codes.tolist() == [[0b00_11_01_10 - 128]]
    assert quantizer.levels(codes).tolist() == [[1, -1, 3, -3]]


def test_five_dimensions_per_byte_are_refused() -> None:
    with pytest.raises(ValueError, match="dimensions per byte 5"):
        Quantizer(step=1.0, per_byte=5)


def test_manifest_of_one_dimension_per_byte_is_unchanged() -> None:
    assert Quantizer(0.5).as_dict() == {"step": 0.5}
    assert Quantizer(**Quantizer(0.5, 3).as_dict()) == Quantizer(0.5, 3)  # type: ignore[arg-type]


def test_no_descriptors_are_no_codes() -> None:
    quantizer = Quantizer(step=1.0, per_byte=4)
    codes = quantizer.encode(np.zeros((0, 8), np.float32))
    assert codes.shape == (0, 2)
    assert quantizer.levels(codes).shape == (0, 8)
