"""Experiments on a copy of a live bench, by REST."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tests.lab import QUIET

M, B, K, F = 2.2090e-10, 7.09e-7, 0.0538, 1.619e-8
BARE = {**QUIET, "schema": 1, "id": "bare"}
SLAVED = {**BARE, "device": {"id": "lcr-350", "bias_v": 5.0}, "plant": {"model": "slaved_lateral"}}


def test_a_sweep_finds_the_device_with_its_faults_and_the_bench_does_not_notice(live):
    bench = live.bench({**BARE, "sensor": {"kind": "ideal", "noise_um": 0.002}}, paused=True)
    live.command(bench["id"], "step", ticks=10)
    live.command(bench["id"], fault="added_mass", severity=0.2)
    live.command(bench["id"], "step", ticks=10)
    before = live.http.get(f"/api/v1/benches/{bench['id']}/digest").json()
    answer = live.http.post(f"/api/v1/benches/{bench['id']}/identification", json={"points": 15, "cycles": 20})
    assert answer.status_code == 200, answer.text
    found = answer.json()["found"]
    for name, unit, truth in (
        ("mass", "_kg", 1.2 * M),
        ("damping", "_ns_m", B),
        ("stiffness", "_n_m", K),
        ("f0", "_hz", math.sqrt(K / 1.2 / M) / (2 * math.pi)),
        ("quality_factor", "", math.sqrt(K * 1.2 * M) / B),
    ):
        error = found[f"{name}_error{unit}"]
        assert 0 < error < 0.01 * truth, name
        assert abs(found[f"{name}{unit}"] - truth) < 4 * error + 1e-4 * truth, name
    zeta = B / (2 * math.sqrt(K * 1.2 * M))
    assert found["f_peak_hz"] == pytest.approx(found["f0_hz"] * math.sqrt(1 - 2 * zeta**2), rel=1e-3)

    tones = answer.json()["tones"]
    f = np.array([tone["frequency_hz"] for tone in tones])
    assert np.all(np.diff(f) > 0) and len(f) >= 28
    w = 2 * np.pi * f
    gain = 1e6 * F / np.abs(K - 1.2 * M * w**2 + 1j * B * w)
    assert [tone["gain_um_per_v"] for tone in tones] == pytest.approx(gain, rel=0.02)
    assert -20 < tones[0]["phase_deg"] < 0 and -180 < tones[-1]["phase_deg"] < -150

    assert live.http.get(f"/api/v1/benches/{bench['id']}/digest").json() == before


def test_a_sweep_that_would_take_too_long_is_refused(live):
    bench = live.bench({**BARE, "environment": {"pressure_pa": 0.01}}, paused=True)
    live.command(bench["id"], "step", ticks=2)
    answer = live.http.post(f"/api/v1/benches/{bench['id']}/identification", json={})
    assert answer.status_code == 422
    error = answer.json()["error"]
    assert "ticks" in error["message"] and "fewer" in error["hint"]


def region(live, scenario, **query):
    bench = live.bench(scenario, paused=True)
    live.command(bench["id"], "step", ticks=5)
    answer = live.http.get(f"/api/v1/benches/{bench['id']}/unstable-region", params=query)
    assert answer.status_code == 200, answer.text
    return answer.json()


def tripped(live, x, v):
    plant = {**SLAVED["plant"], "initial_displacement_um": x, "initial_velocity_um_ms": v, "thermal_noise": False}
    device = {**SLAVED["device"], "damping_ns_m": 1e-12}
    still = {"kind": "constant", "amplitude_v": 0.0}
    bench = live.bench({**SLAVED, "device": device, "plant": plant, "reference": still}, paused=True)
    live.command(bench["id"], "step", ticks=400)
    return live.get(bench["id"])["state"] == "tripped"


def test_the_fold_is_where_the_text_has_it(live):
    found = region(live, SLAVED)
    assert found["plant"] == "slaved_lateral"
    assert sorted(fold["x_um"] for fold in found["folds"]) == pytest.approx([-1.660, 1.660], abs=0.001)
    assert [abs(fold["volts"]) for fold in found["folds"]] == pytest.approx([3.914, 3.914], abs=0.001)


def test_the_boundary_divides_what_stays_from_what_pulls_in(live):
    edge = region(live, SLAVED)["boundary"]
    x, speed = np.array(edge["x_um"]), np.array(edge["speed_um_ms"])
    assert speed[0] == pytest.approx(0.0, abs=1.0) and speed[-1] == pytest.approx(0.0, abs=1.0)
    for place in (0.0, 2.0):
        limit = float(np.interp(place, x, speed))
        assert not tripped(live, place, 0.97 * limit)
        assert tripped(live, place, 1.03 * limit)


def test_a_plant_that_cannot_pull_in_has_no_map(live):
    found = region(live, BARE)
    assert found["plant"] == "linear" and found["folds"] == [] and found["boundary"] is None


def test_what_needs_one_displacement_says_so_to_a_gyroscope(live):
    bench = live.bench({"schema": 1, "id": "two-axes", "device": {"id": "gyro-c"}}, paused=True)
    path = f"/api/v1/benches/{bench['id']}"
    found = live.http.get(f"{path}/unstable-region").json()
    assert found["plant"] == "gyroscope" and found["folds"] == [] and found["boundary"] is None
    answer = live.http.post(f"{path}/identification", json={})
    assert answer.status_code == 422 and "along x, y" in answer.json()["error"]["message"]


def test_the_cost_of_every_plant_is_measured(live):
    bench = live.bench(BARE, paused=True)
    live.command(bench["id"], "step", ticks=5)
    found = live.http.get(f"/api/v1/benches/{bench['id']}/plants").json()
    cost = {plant["name"]: plant for plant in found["plants"]}
    assert set(cost) >= {"linear", "nonlinear", "slaved_lateral", "planar"}
    assert found["tick_ns"] == 10_000
    # a tick does some hundreds of operations, each of a good part of a ns; the planar plant forty steps of them
    assert 50 < cost["linear"]["ns_per_tick"] < cost["planar"]["ns_per_tick"] < 1e6
    # 20 V of bias is more than this calibration bears: it says so instead of a figure
    assert cost["slaved_lateral"]["ns_per_tick"] is None and cost["slaved_lateral"]["refused"]
