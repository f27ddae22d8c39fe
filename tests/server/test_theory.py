"""Theory over REST."""

from __future__ import annotations

import pytest

BASE = "/api/v1/theory"


def test_positive_real(live):
    found = live.http.post(f"{BASE}/positive-real", json={"numerator": [1, 1], "denominator": [1, 5, 6]}).json()
    assert found["strictly_positive_real"] and found["reasons"] == [] and found["relative_degree"] == 1
    assert len(found["frequency"]) == len(found["real"]) == len(found["imaginary"])
    for w, real, imaginary in zip(found["frequency"], found["real"], found["imaginary"], strict=True):
        assert complex(real, imaginary) == pytest.approx((1j * w + 1) / ((1j * w) ** 2 + 5j * w + 6), rel=1e-9)
    other = live.http.post(f"{BASE}/positive-real", json={"numerator": [1], "denominator": [1, 0, 0]}).json()
    assert not other["positive_real"] and len(other["reasons"]) == 3


def test_positive_definite_and_persistency(live):
    found = live.http.post(f"{BASE}/positive-definite", json={"matrix": [[2, 1], [1, 2]]}).json()
    assert found["positive_definite"] and found["eigenvalues"] == pytest.approx([1, 3])
    one = live.http.post(f"{BASE}/persistency", json={"tones": [{"amplitude": 10, "frequency": 0.1}]}).json()
    assert not one["exciting"] and one["condition"] is None
    two = [{"amplitude": 10, "frequency": w} for w in (0.1, 0.7)]
    assert live.http.post(f"{BASE}/persistency", json={"tones": two}).json()["exciting"]


def test_instability_map(live):
    body = {"rule": "dressler", "frequencies": 5, "gains": 4, "lowest_frequency": 0.5, "highest_frequency": 1.5}
    found = live.http.post(f"{BASE}/instability-map", json=body).json()
    assert len(found["growth"]) == 5 and all(len(row) == 4 for row in found["growth"])
    assert found["critical_gain_constant"] == pytest.approx(0.2, rel=1e-3)
    assert found["growth"][-1][0] > 0  # above resonance every gain is unstable


REFUSED = [
    ("positive-real", {"numerator": [0], "denominator": [1]}, "numerator"),
    ("positive-real", {"numerator": [], "denominator": [1]}, "numerator"),
    ("positive-real", {"numerator": ["s"], "denominator": [1]}, "numerator.0"),
    ("positive-definite", {"matrix": [[1, 2]]}, "matrix"),
    ("persistency", {"tones": [{"amplitude": 1, "frequency": 1}] * 2}, "tones"),
    ("instability-map", {"rule": "none"}, "rule"),
    ("instability-map", {"lowest_frequency": 3}, "lowest_frequency"),
    ("instability-map", {"frequencies": 200, "gains": 200}, "frequencies"),
]


def test_bad_input_is_named(live):
    for path, body, field in REFUSED:
        answer = live.http.post(f"{BASE}/{path}", json=body)
        assert answer.status_code == 422 and answer.json()["error"]["field"] == field, (path, body)


def test_a_plant_in_seconds_runs_near_real_time(live):
    made = live.http.post("/api/v1/benches", json={"scenario": "appB-mit", "paused": True}).json()
    assert made["time_scale"] == 1.0 and "gain_adaptation" in made["controllers"]
    slow = {"scenario": "appB-mit", "paused": True, "time_scale": 0.01}
    assert live.http.post("/api/v1/benches", json=slow).json()["time_scale"] == 0.01
