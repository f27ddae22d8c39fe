"""How packed numbers follow a value, against functions whose dependence is known."""

from __future__ import annotations

import numpy as np
import pytest

from core.errors import InputError
from scenarios.in_a_file.dependence import POINTS, dependence


def test_copies_and_multiples_move_freely_and_constants_stay():
    found = dependence(lambda x: np.array([7.0, x, 0.3 * x, -x]), -0.5, 2.0, [0.05])
    assert found["places"].tolist() == [1, 2, 3]
    assert found["factors"].tolist() == [1.0, 0.3, -1.0]
    value = 1.2345678901234567
    assert (value * found["factors"]).tolist() == [value, 0.3 * value, -value]


@pytest.mark.parametrize(
    "pack", [lambda x: np.array([1.0 + x]), lambda x: np.array([x * x]), lambda x: np.array([x / 3.0]), np.array]
)
def test_any_other_number_is_known_at_the_points_of_a_grid(pack):
    found = dependence(lambda x: np.ravel(pack(np.ceil(8.0 * x) if pack is np.array else x)), 0.0, 1.0, [0.05, 0.7071])
    assert "factors" not in found
    grid = found["grid"]
    assert grid == sorted(set(grid)) and {0.05, 0.7071} <= set(grid) and len(grid) <= POINTS + 2
    for value, numbers in zip(grid, found["numbers"], strict=True):
        expected = np.ceil(8.0 * value) if pack is np.array else pack(value)
        assert numbers.tolist() == np.ravel(expected).tolist()


def test_a_multiple_that_holds_only_at_the_power_of_two_is_no_multiple():
    # all but one value would do: the rest of a division of the last bit
    found = dependence(lambda x: np.array([np.nextafter(x, 2.0) if x not in (0.5, 1.0) else x]), 0.0, 1.0, [1.0])
    assert "grid" in found


@pytest.mark.parametrize("high", [1.0, 1e3, 1e6, 7.3e4])
@pytest.mark.parametrize("pack", [lambda x: x * 1e-6 * 1.5174271293851465, lambda x: x / 1000.0])
def test_a_product_that_is_rounded_twice_is_no_multiple(pack, high):
    found = dependence(lambda x: np.array([pack(x)]), 0.0, high, [high])
    assert "grid" in found


def test_the_ends_of_a_grid_are_in_the_range_to_the_last_bit():
    low, high = 0.015915494309189534, 1.5915494309189535
    grid = dependence(lambda x: np.array([1.0 + x]), low, high, [0.5])["grid"]
    assert (grid[0], grid[-1]) == (low, high)


def test_a_range_without_values_is_refused():
    with pytest.raises(InputError, match="no values between"):
        dependence(lambda x: np.array([x]), 1.0, 1.0, [1.0])
