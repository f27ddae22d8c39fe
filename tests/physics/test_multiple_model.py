"""A law for each hypothesis: with a certain bank it is the LQG of that device, and factors are another device."""

from __future__ import annotations

import numpy as np
import pytest

from core.board.parse import parse
from core.control.lqg import Lqg
from core.control.multiple_model import MOST, MultipleModel
from core.diagnose.lanes import LANE
from tests.lab import RICH, document, make, play

ONE = {"sensor.noise_um": 0.05, "diagnosers.slow": {"kind": "mmae", "hypotheses": [{"name": "heavy", "mass": 1.2}, {"name": "heavy-too", "mass": 1.2}]}}  # fmt: skip  # noqa: E501


def test_it_has_room_for_each_hypothesis_of_a_bank() -> None:
    assert MOST == LANE


@pytest.mark.parametrize("combine", ["blend", "switch"])
def test_where_all_hypotheses_are_one_device_it_is_the_lqg_of_that_device(combine: str) -> None:
    own = {"controller": {"kind": "multiple_model", "diagnoser": "slow", "combine": combine}}
    many = play(make({**ONE, **own}, base=RICH), 600)
    one = play(make({**ONE, "controller": {"kind": "lqg", "mass_ratio": 1.2}}, base=RICH), 600)
    np.testing.assert_allclose(many["drive.voltage"], one["drive.voltage"], rtol=0, atol=0.006)  # a step of the drive
    np.testing.assert_allclose(many["plant.displacement"], one["plant.displacement"], atol=1e-3)


def test_on_a_bench_without_the_bank_it_is_the_lqg_of_the_nominal_device() -> None:
    bench = {**RICH, "diagnosers": {}}
    many = play(make({"controller": {"kind": "multiple_model"}}, base=bench), 400)
    one = play(make({"controller": {"kind": "lqg"}}, base=bench), 400)
    assert many["drive.voltage"].tobytes() == one["drive.voltage"].tobytes()


def test_the_factors_of_a_law_are_another_device() -> None:
    nominal = parse(document({}, RICH))
    heavy = parse(document({"device.mass_kg": 1.2 * nominal.nominal.mass * 1e-6}, RICH))
    assert heavy.nominal.mass == pytest.approx(1.2 * nominal.nominal.mass, rel=1e-12)
    own = Lqg.packed(Lqg.Params(mass_ratio=1.2), nominal.context())
    other = Lqg.Packed(Lqg.packed(Lqg.Params(), heavy.context()))
    np.testing.assert_allclose(Lqg.Packed(own).regulate, other.regulate, rtol=1e-9)
    np.testing.assert_allclose(Lqg.Packed(own).correct, other.correct, rtol=1e-9)
    assert MultipleModel.packed(MultipleModel.Params(diagnoser="slow"), nominal.context())[0] == 2.0
