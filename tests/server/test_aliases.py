"""Aliases of a list of hypotheses, by REST."""

from __future__ import annotations

import math

import pytest

from tests.lab import QUIET

M, B, K, F = 2.2090e-10, 7.09e-7, 0.0538, 1.619e-8
NOISE_UM = 0.05
BANK = {
    "kind": "mmae",
    "probability_floor": 0.01,
    "hypotheses": [{"name": "healthy"}, {"name": "m+5", "mass": 1.05}, {"name": "k-5", "stiffness": 0.95}],
}
WATCHED = {
    **QUIET,
    "schema": 1,
    "id": "watched",
    "sensor": {"kind": "ideal", "noise_um": NOISE_UM},
    "reference": {"kind": "sine", "amplitude_v": 10.0, "frequency_hz": 2000.0},
    "diagnosers": {"kalman": BANK, "regions": {"kind": "regions"}},
}


def url(bench, name="kalman"):
    return f"/api/v1/benches/{bench['id']}/diagnosers/{name}"


def test_mass_and_stiffness_coincide_where_one_tone_cannot_part_them(live):
    bench = live.bench(WATCHED, paused=True)
    omega = 2 * math.pi * 2000
    ratio = M * omega**2 / K  # dk/k = -(w/w0)^2 dm/m
    same = [{"name": "healthy"}, {"name": "m+5", "mass": 1.05}, {"name": "k-", "stiffness": 1 - 0.05 * ratio}]
    found = live.http.post(f"{url(bench)}/aliases", json={"hypotheses": same}).json()
    assert found["map"]["stiffness_per_mass"] == pytest.approx(-ratio, rel=1e-3)
    closest = found["map"]["pairs"][0]
    assert {closest["first"], closest["second"]} == {"m+5", "k-"} and closest["coincident"]
    gain = 10 * 1e6 * F / abs(K - M * omega**2 + 1j * B * omega)
    assert found["map"]["responses"][0]["amplitudes_um"] == pytest.approx([gain], rel=1e-3)
    assert found["f0_hz"] == pytest.approx(math.sqrt(K / M) / (2 * math.pi), rel=1e-3)
    assert found["sensor_noise_um"] == NOISE_UM

    sweep = found["sweep"]
    # far above resonance nothing moves, and everything coincides
    near = [i for i, hz in enumerate(sweep["frequency_hz"]) if hz < 3000]
    least = min(near, key=lambda i: sweep["distance_um"][i])
    assert sweep["frequency_hz"][least] == pytest.approx(2000, rel=0.02)
    assert set(sweep["pairs_named"][sweep["pair"][least]].values()) == {"m+5", "k-"}

    tones = [{"frequency_hz": f, "amplitude_v": 10.0} for f in (2000.0, 1000.0)]
    parted = live.http.post(f"{url(bench)}/aliases", json={"hypotheses": same, "tones": tones}).json()
    assert not parted["map"]["pairs"][0]["coincident"]


def test_aliases_need_tones_and_a_list(live):
    bench = live.bench({**WATCHED, "reference": {"kind": "prbs", "amplitude_v": 10.0}}, paused=True)
    answers = [
        live.http.post(f"{url(bench)}/aliases", json={}),
        live.http.post(f"{url(bench)}/aliases", json={"hypotheses": [{"name": "one", "mass": -1}, {"name": "two"}]}),
        live.http.post(f"{url(bench, 'regions')}/aliases", json={}),
    ]
    assert [answer.json()["error"]["field"] for answer in answers] == ["tones", "hypotheses.0.mass", "name"]


def test_a_frequency_whose_square_underflows_is_answered(live):
    bench = live.bench(WATCHED, paused=True)
    body = {"hypotheses": BANK["hypotheses"], "tones": [{"amplitude_v": 10.0, "frequency_hz": 1e-200}]}
    answer = live.http.post(f"{url(bench)}/aliases", json=body)
    assert answer.status_code in (200, 422), answer.text
