"""Young's modulus belongs to the beams: temperature, age and stiffness of all beams reach whatever is elastic."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy import integrate, optimize

from core.board.board import Board
from core.device.catalogue import device
from core.device.frame import Damage, stiffness
from scenarios.design import designed, device_figures
from scenarios.measure.lateral import lateral_metrics
from tests.lab import inject, make, play
from tests.physics.plane import EPS, STILL, XR, XS, G, N, T, bench
from tests.physics.plane import KT as HEAT

PER_K = 63e-6
AGED = 1.0 / 0.572
WHOLE = 0.05380, 205.4, 4.51e-7
"""Stiffness along x, sideways and in rotation at 300 K: N/m, N/m, N m/rad."""


def closed_pull_in(scale: float, rotation_nm: float = 4.51e-7) -> float:
    """Bias at which the torque of both combs outgrows the suspension, V."""
    lever = (XR**3 - XS**3) / 3 * 1e-18
    return math.sqrt(scale * rotation_nm * (G * 1e-6) ** 3 / (4 * N * EPS * T * 1e-6 * lever))


def suspension(board: Board) -> np.ndarray:
    """Return the elasticity of the planar plant in the last sample, N/m, N/m^3 and N m/rad."""
    board.advance(3)
    k = board.wiring.state("plant").suspension
    return np.array([k.stiffness, k.lateral_stiffness, k.rotation_stiffness * 1e-12, k.cubic * 1e12])


CAUSES: dict[str, tuple[dict[str, Any], dict[str, float], float]] = {
    "hot": ({"environment.temperature_k": 500.0}, {}, 1 - PER_K * 200),
    "cold": ({"environment.temperature_k": 200.0}, {}, 1 + PER_K * 100),
    "aged": ({"environment.age_weeks": 4.0}, {}, AGED),
    "ageing": ({}, {"ageing": 4.0}, AGED),
    "stiffness": ({}, {"stiffness": 0.1}, 1.1),
    "softness": ({}, {"stiffness": -0.3}, 0.7),
    "all": ({"environment.temperature_k": 400.0}, {"stiffness": 0.2, "ageing": 4.0}, (1 - PER_K * 100) * 1.2 * AGED),
}


def changed(cause: str, model: str = "planar", **plant: Any) -> tuple[Board, float]:
    values, faults, scale = CAUSES[cause]
    board = bench(values={**values, "plant.model": model}, **plant)
    board.advance(1)
    inject(board, **faults)
    return board, scale


@pytest.mark.parametrize("cause", CAUSES)
def test_every_stiffness_of_the_suspension_goes_with_the_modulus(cause):
    board, scale = changed(cause, cubic_n_m3=1e7)
    nominal = suspension(bench(cubic_n_m3=1e7))
    np.testing.assert_allclose(nominal, [*WHOLE, 1e7], rtol=3e-3)
    np.testing.assert_allclose(suspension(board), scale * nominal, rtol=1e-9)


@pytest.mark.parametrize(
    ("model", "cause"), [*(("linear", cause) for cause in CAUSES), ("planar", "softness"), ("planar", "all")]
)
def test_pull_in_goes_with_the_root_of_the_modulus(cause, model):
    board, scale = changed(cause, model)
    board.advance(3)
    assert lateral_metrics(board)["device.pull_in_v"] == pytest.approx(closed_pull_in(scale), rel=3e-3)
    whole = bench(values={"plant.model": model})
    whole.advance(3)
    ratio = lateral_metrics(board)["device.pull_in_v"] / lateral_metrics(whole)["device.pull_in_v"]
    assert ratio == pytest.approx(math.sqrt(scale), rel=1e-5)


def test_pull_in_of_the_reference_device_at_500_k():
    spec = designed({"id": "lcr-350"}, {"temperature_k": 500.0})
    nominal = device_figures(designed({"id": "lcr-350"}, {}))["pull_in_v"]
    assert device_figures(spec)["pull_in_v"] == pytest.approx(nominal * math.sqrt(1 - PER_K * 200), rel=1e-12)
    assert device_figures(spec)["pull_in_v"] == pytest.approx(27.905, abs=5e-3)


def test_the_plane_pulls_in_hot_and_stays_at_room_temperature():
    """28.03 V is between the thresholds of 27.905 V at 500 K and 28.082 V at 300 K; heat gives the first push."""
    assert closed_pull_in(1 - PER_K * 200) < 28.03 < closed_pull_in(1.0) + 0.01
    ends = {}
    for kelvin in (300.0, 500.0):
        board = bench(28.03, values={"environment.temperature_k": kelvin}, thermal_noise=True)
        ends[kelvin] = play(board, 2000)["plant.contact"].max()
    assert ends == {300.0: 0.0, 500.0: 1.0}


def test_heat_shakes_the_rotation_by_the_softer_spring():
    r"""Equipartition, :math:`\langle\theta^2\rangle=k_BT/k_\theta`, at 500 K and for beams of 0.3 of the modulus."""
    board = bench(0.0, values={"environment.temperature_k": 500.0, "sample_rate_khz": 100.0}, thermal_noise=True)
    board.advance(1)
    inject(board, stiffness=-0.7)
    turn = play(board, 60_000)["plant.rotation"][2000:]
    spring = 4.51e-7 * 0.3 * (1 - PER_K * 200)
    assert np.sqrt(np.mean(turn**2)) == pytest.approx(math.sqrt(HEAT * 500 / 300 / spring) * 1e3, rel=0.04)


def test_a_hardening_spring_softens_as_a_whole():
    """Rest of k x + k3 x^3 = F at 500 K, by a root finder; half of the force is taken by the cubic part."""
    scale = 1 - PER_K * 200
    still = {"reference": {"kind": "constant", "amplitude_v": -20.0}, "environment.temperature_k": 500.0}
    values = {"device": {"id": "lcr-350"}, "plant": {"model": "nonlinear", "cubic_n_m3": 2e9, "thermal_noise": False}}
    x = play(make({**values, **still}), 5000)["plant.displacement"][-1]
    force = 4 * N * EPS * T / G * 10.0 * 20.0
    k, k3 = device({"id": "lcr-350"}).resolved["stiffness_n_m"], 2e9
    rest = optimize.brentq(lambda x: scale * (k * x + k3 * x**3) - force, 0.0, 2e-5)
    assert x == pytest.approx(rest * 1e6, rel=1e-6)


def test_the_path_of_a_hot_hardening_plant_against_an_adaptive_solver():
    scale, k3 = 1 - PER_K * 300, 5e9
    start = {"initial_displacement_um": 5.0, "substeps": 16}
    values = {"device": {"id": "lcr-350"}, "environment.temperature_k": 600.0, **STILL}
    plant = {"plant": {"model": "nonlinear", "cubic_n_m3": k3, "thermal_noise": False, **start}}
    board = make({**values, **plant})
    x = play(board, 100)["plant.displacement"]
    si = device({"id": "lcr-350"}).resolved
    m, k, b = si["mass_kg"], si["stiffness_n_m"], si["damping_ns_m"] * board.value("effects.damping_scale")
    found = integrate.solve_ivp(
        lambda _, s: [s[1], -(b * s[1] + scale * (k * s[0] + k3 * s[0] ** 3)) / m],
        (0.0, 99e-5),
        [5e-6, 0.0],
        t_eval=[99e-5],
        rtol=1e-10,
        atol=1e-16,
    )
    assert x[-1] == pytest.approx(found.y[0, -1] * 1e6, abs=1e-4)


def test_one_stiff_side_is_the_frame_with_one_stiff_side_and_nothing_more():
    """Stiffness sideways and in rotation from the frame of beams with the modulus of one side raised."""
    board = bench()
    board.advance(1)
    inject(board, stiffness_one_side=0.4)
    drawing = device({"id": "lcr-350"}).drawing
    whole, stiffer = stiffness(drawing), stiffness(drawing, Damage(side_scale=1.4))
    expected = [0.0538 * 1.2, 205.4 * stiffer[1, 1] / whole[1, 1], 4.51e-7 * stiffer[2, 2] / whole[2, 2], 0.0]
    np.testing.assert_allclose(suspension(board), expected, rtol=3e-3)
