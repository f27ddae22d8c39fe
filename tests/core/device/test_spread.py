"""Process spread against linear error propagation, and Table 2.1 against the equations."""

from __future__ import annotations

import numpy as np
import pytest

from core.device.catalogue import device
from core.device.geometry import Geometry
from core.device.spread import CARRIERS, MISSING, PRINTED, STEPS, Tolerances, draw, evaluate, sensitivity
from core.errors import InputError

N = 20_000
# coefficients of variation in percent from an independent run of as many draws
INDEPENDENT = {
    "mass_kg": 2.8,
    "stiffness_n_m": 19.8,
    "damping_ns_m": 3.2,
    "f0_hz": 9.7,
    "quality_factor": 10.1,
    "force": 3.8,
}


@pytest.fixture(scope="module")
def drawing() -> Geometry:
    geometry = device({"id": "lcr-350"}).geometry
    assert geometry is not None
    return geometry


@pytest.fixture(scope="module")
def spread(drawing):
    return draw(drawing, Tolerances(), N, 1)


def test_variations_agree_within_statistical_error(spread):
    for name, expected in INDEPENDENT.items():
        # error of a standard deviation of N draws, twice over, and the rounding to one decimal
        allowed = 4 * expected / np.sqrt(2 * N) * np.sqrt(2) + 0.05
        assert spread.variation_pct(name) == pytest.approx(expected, abs=allowed), name
    assert spread.percentile("f0_hz", 1) == pytest.approx(1942, abs=25)
    assert spread.percentile("f0_hz", 99) == pytest.approx(3071, abs=25)
    assert spread.correlation("stiffness_n_m", "f0_hz") == pytest.approx(0.99, abs=0.01)
    assert spread.correlation("mass_kg", "force") == pytest.approx(0.93, abs=0.01)


def test_small_tolerances_propagate_linearly(drawing):
    """var f = sum (df/dx sd)^2, with derivatives taken here."""
    small = Tolerances(*(1e-3 * value for value in (0.05, 0.03, 0.05, 0.08, 5.0)))
    found = draw(drawing, small, 50_000, 3, cut=6.0)
    for name in ("mass_kg", "stiffness_n_m", "damping_ns_m", "f0_hz", "force"):
        total = 0.0
        for number, sd in vars(small).items():
            at = getattr(drawing, number)
            up, down = (evaluate(drawing.model_copy(update={number: at + s * sd}))[name] for s in (1, -1))
            total += float((up - down) / 2) ** 2
        expected = 100 * np.sqrt(total) / float(evaluate(drawing)[name])
        assert found.variation_pct(name) == pytest.approx(expected, rel=0.015), name


def test_whole_wafers_go_through_the_same_equations(drawing, spread):
    for i in (0, 1, N - 1):
        one = Geometry(**{**drawing.model_dump(), **{name: float(v[i]) for name, v in spread.drawn.items()}})
        assert one.mass_kg() == pytest.approx(spread.found["mass_kg"][i], rel=1e-12)
        assert one.stiffness_n_m() == pytest.approx(spread.found["stiffness_n_m"][i], rel=1e-12)
        assert one.damping_ns_m() == pytest.approx(spread.found["damping_ns_m"][i], rel=1e-12)


def test_deviations_are_normal_cut_and_repeatable(drawing, spread):
    again, other = draw(drawing, Tolerances(), N, 1), draw(drawing, Tolerances(), N, 2)
    for name, values in spread.drawn.items():
        deviation = (values - getattr(drawing, name)) / getattr(Tolerances(), name)
        assert np.max(np.abs(deviation)) <= 3.0
        assert np.std(deviation) == pytest.approx(0.9866, abs=0.02)  # of a normal cut at 3
        assert np.array_equal(values, again.drawn[name]) and not np.array_equal(values, other.drawn[name])


def test_sensitivities_have_closed_forms(drawing):
    width = 2.0 - 2 * 0.23835
    etched = sensitivity(drawing, "beam_bias_um", 0.1)
    assert etched["stiffness_n_m"] == pytest.approx(
        100 * ((1 - 0.2 / width) ** 3 - 1), abs=0.3
    )  # trusses give a little
    assert etched["f0_hz"] == pytest.approx(-19, abs=0.3) and etched["force"] == 0.0
    thick = sensitivity(drawing, "thickness_um", 0.1)
    assert [thick[name] for name in ("mass_kg", "stiffness_n_m", "force")] == pytest.approx([5.0, 5.0, 5.0])
    assert thick["f0_hz"] == pytest.approx(0.0, abs=1e-9)
    assert thick["quality_factor"] == pytest.approx(3.3, abs=0.15)
    assert sensitivity(drawing, "film_gap_um", 0.1)["damping_ns_m"] == pytest.approx(-3.1, abs=0.15)
    assert sensitivity(drawing, "youngs_modulus_gpa", 1.0)["stiffness_n_m"] == pytest.approx(100 / 164)
    comb = sensitivity(drawing, "comb_bias_um", 0.1)
    assert comb["force"] == pytest.approx(100 * (2.1 / 2.3 - 1))
    assert comb["mass_kg"] == pytest.approx(-4.4, abs=0.05) and comb["damping_ns_m"] == pytest.approx(-6.1, abs=0.4)


def test_missing_dots_are_those_the_equations_demand(drawing):
    keys = {"mass": "mass_kg", "stiffness": "stiffness_n_m", "damping": "damping_ns_m", "force": "force"}
    for step, numbers in CARRIERS.items():
        for quantity, key in keys.items():
            moves = any(abs(sensitivity(drawing, number, 0.05)[key]) > 0.01 for number in numbers)
            named = step in PRINTED[quantity] or step in MISSING.get(quantity, {})
            # density is a mechanical property too, so mass has a printed dot the map of numbers does not carry
            assert moves == named or (quantity, step) == ("mass", "mechanical properties"), (quantity, step)
            assert not (step in PRINTED[quantity] and step in MISSING.get(quantity, {}))
    assert all(set(steps) <= set(STEPS) for steps in PRINTED.values())


def test_a_beam_that_vanishes_is_refused(drawing):
    with pytest.raises(InputError) as error:
        draw(drawing, Tolerances(beam_bias_um=0.5), 1000, 1)
    assert error.value.field == "device.geometry.beam_width_um"
