"""Gyroscopes driven by volts on their combs: the figures of the library, the force of each comb, the converter."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np
import pytest

from core.device.catalogue import device
from core.errors import InputError
from scenarios.library import get
from scenarios.run import run
from scenarios.schema import Scenario
from tests.two_axis import GYRO

EPSILON_0 = 8.8541878128e-12
COMB = {"bias_v": 20.0, "fingers": 20_000, "thickness_um": 60.0, "gap_um": 3.0}
"""Strong enough for the hundreds of uN of set A off resonance."""
SHORT = (
    "ch6-mimo-late",
    "ch6-sense-axis-sync",
    "gyro-adaptive",
    "gyro-diagnosis",
    "gyro-finger-short",
    "gyro-first-look",
    "gyro-half-sample",
    "gyro-off-resonance",
    "gyro-waveform",
    "gyro-whole-angle",
)
LONG = (
    "ch6-drift",
    "ch6-gyro-imperfections",
    "ch6-mimo",
    "ch6-phase-sync",
    "gyro-comb-device",
    "gyro-forced-drive",
    "gyro-not-exciting",
    "gyro-small-rates",
    "gyro-swinging-rate",
)


def by_volts(document: dict[str, Any], **drive: object) -> Scenario:
    """Return a scenario whose forces come from volts on combs."""
    found = copy.deepcopy(document)
    found["drive"] = {**found.get("drive", {}), "by": "volts", **drive}
    electrodes = {"drive": COMB, "sense": COMB}
    found["device"] = {**found["device"], "electrodes": electrodes}
    if "partner" in found["plant"]:
        found["plant"]["partner"]["electrodes"] = electrodes
    return Scenario.load(found)


@pytest.mark.parametrize("name", [*SHORT, *(pytest.param(name, marks=pytest.mark.long) for name in LONG)])
def test_the_table_of_figures_holds_with_forces_from_volts(name: str) -> None:
    result = run(by_volts(get(name).document))
    assert result.trip is None
    assert all(entry["ok"] for entry in result.expectations()), result.expectations()
    volts = by_volts(get(name).document).spec.nominal.comb_x.per_volt
    forces = result.signal("drive.x.force")
    assert np.abs(forces).max() > 0.0
    assert np.abs(forces).max() <= volts * 20.0


def test_two_combs_pull_with_the_square_of_their_volts() -> None:
    """F = 1/2 dC/dx [(V_b + v)^2 - (V_b - v)^2] with dC/dx = 2 n eps t/g, from the very voltages on the combs."""
    result = run(by_volts({**GYRO, "duration_ms": 2.0}), taps=True)
    volts, forces = result.signal("drive.x.voltage"), result.signal("drive.x.force")
    slope = 2.0 * COMB["fingers"] * EPSILON_0 * COMB["thickness_um"] / COMB["gap_um"]
    more, less = COMB["bias_v"] + volts, COMB["bias_v"] - volts
    assert np.abs(volts).max() > 1e-3
    np.testing.assert_allclose(1e-6 * forces, 0.5 * slope * (more**2 - less**2), rtol=1e-9, atol=1e-18)


def test_volts_on_combs_are_the_same_force() -> None:
    """The same uN as by force, but for the rounding of a division and two squares."""
    ticks = {**GYRO, "duration_ms": 20.0}
    by_force, volts = run(Scenario.load(ticks)), run(by_volts(ticks))
    for signal in ("drive.x.force", "drive.y.force"):
        forces = by_force.signal(signal)
        assert np.abs(forces).max() > 0.1
        np.testing.assert_allclose(volts.signal(signal), forces, atol=1e-9 * np.abs(forces).max())


def test_a_partner_is_driven_by_its_own_combs() -> None:
    """Half the fingers need twice the volts for the same force."""
    own = {"drive": {**COMB, "fingers": 100}, "sense": COMB}
    partner = {"drive": {**COMB, "fingers": 50}, "sense": COMB}
    document = {
        **GYRO,
        "device": {"id": "gyro-2-2", "electrodes": own},
        "plant": {"model": "gyroscope_pair", "partner": {"electrodes": partner}, "thermal_noise": False},
        "controller": {"kind": "open_loop_rate"},
        "slots": {"drive": "drive_tracking"},
        "sensor": {"kind": "pick_off"},
        "drive": {"by": "volts"},
        "duration_ms": 2.0,
    }
    result = run(Scenario.load(document), taps=True)
    for axis, fingers in (("x", 100), ("partner_x", 50)):
        forces, volts = result.signal(f"drive.{axis}.force"), result.signal(f"drive.{axis}.voltage")
        slope = 2.0 * fingers * EPSILON_0 * COMB["thickness_um"] / COMB["gap_um"]
        assert np.abs(forces).max() > 0.0
        np.testing.assert_allclose(1e-6 * forces, 2.0 * slope * COMB["bias_v"] * volts, rtol=1e-9, atol=1e-18)
    with pytest.raises(InputError, match="no combs for volts along partner_y"):
        Scenario.load({**document, "plant": {**document["plant"], "partner": {"electrodes": {"drive": COMB}}}})


def test_the_converter_and_the_limit_are_in_volts() -> None:
    result = run(by_volts({**GYRO, "duration_ms": 2.0}, bits=8, converter_limit_v=1.0 / 128.0), taps=True)
    volts = result.signal("drive.x.voltage")
    assert np.abs(volts).max() == 1.0 / 128.0
    steps = volts * 128.0 * 128.0  # 2^8 steps over twice the limit
    assert (steps == np.round(steps)).all()
    assert result.signal("drive.x.saturated").max() == 1.0


def test_a_parasitic_capacitance_is_a_charge_against_the_charge_of_a_displacement() -> None:
    """C_p v_x against 2 dC/dy V_b y: pm/uN of 1 aF, and the rate that an open loop takes it for."""
    found = device({"id": "gyro-c", "electrodes": {"drive": COMB, "sense": COMB}}).metrics()
    slope = 2.0 * COMB["fingers"] * EPSILON_0 * COMB["thickness_um"] / COMB["gap_um"]  # F/m
    per_volt = 2.0 * slope * COMB["bias_v"]  # N/V, and C/m
    passed = 1e-18 * (1e-6 / per_volt) / per_volt  # m of 1 aF and 1 uN
    assert found["gyro.feed_through_pm_un_af"] == pytest.approx(1e12 * passed, rel=1e-9)
    omega = 2.0 * np.pi * found["gyro.mode_hz.1"]
    spring = 987.2898 - 1.58e-6 * omega**2
    rate = np.degrees(passed * 1e6 * 7.4945e-6 * spring / (4.0 * 1.58e-6))
    assert found["gyro.feed_through_dps_af"] == pytest.approx(rate, rel=1e-3)


def test_a_drawn_device_has_the_combs_of_its_drawing() -> None:
    drawn = device({"id": "gyro-lcr-350"})
    gradient = 2.0 * 87 * EPSILON_0 * 2.0 / 2.1
    assert drawn.metrics()["gyro.force_x_nn_per_v2"] == pytest.approx(2e9 * gradient, rel=1e-12)
    other = device({"id": "gyro-lcr-350", "electrodes": {"drive": {"fingers": 174}}})
    assert other.metrics()["gyro.force_x_nn_per_v2"] == pytest.approx(4e9 * gradient, rel=1e-12)
    assert other.metrics()["gyro.force_y_nn_per_v2"] == drawn.metrics()["gyro.force_y_nn_per_v2"]


@pytest.mark.parametrize(
    ("changes", "field", "words"),
    [
        ({"drive": {"by": "volts"}}, "drive.by", ["no combs", "along x, y"]),
        (
            {
                "device": {"id": "gyro-a", "electrodes": {"drive": COMB, "sense": COMB}},
                "drive": {"by": "volts", "quantum_un": 1},
            },
            "drive.quantum_un",
            ["bits"],
        ),
        ({"drive": {"converter_limit_v": 3.0}}, "drive.converter_limit_v", ["by force"]),
        ({"device": {"id": "gyro-a", "electrodes": {"drive": {}}}}, "device", ["fingers", "no drawing"]),
        ({"device": {"id": "gyro-a", "electrodes": {"drive": {**COMB, "bias_v": 0}}}}, "bias_v", ["above 0"]),
    ],
)
def test_volts_without_combs_are_refused(changes: dict[str, object], field: str, words: list[str]) -> None:
    with pytest.raises(InputError) as caught:
        Scenario.load({**GYRO, "duration_ms": 1.0, **changes})
    assert field in caught.value.field + caught.value.message
    assert all(word in str(caught.value) for word in words), str(caught.value)


def test_electrodes_of_a_resonator_are_refused() -> None:
    with pytest.raises(InputError, match="electrodes belong to a gyroscope"):
        device({"id": "lcr-350", "electrodes": {}})
