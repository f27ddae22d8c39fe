"""A sample explained and aliases, by REST."""

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


def read(live, bench, signals, tick):
    query = {"signals": ",".join(signals), "start_tick": tick, "end_tick": tick + 1, "columns": 1}
    found = live.http.get(f"/api/v1/benches/{bench['id']}/trace", params=query).json()["signals"]
    return [found[name]["min"][0] for name in signals]


@pytest.mark.parametrize("tick", [0, 1, 150])
def test_a_posterior_is_the_prior_times_the_density_of_the_residual(live, tick):
    bench = live.bench(WATCHED, paused=True)
    live.command(bench["id"], "step", ticks=300)
    answer = live.http.get(f"{url(bench)}/explanation", params={"tick": tick})
    assert answer.status_code == 200, answer.text
    found = answer.json()
    names = [model["name"] for model in found["models"]]
    assert names == ["healthy", "m+5", "k-5"] and found["tick"] == tick

    assert [m["residual_um"] for m in found["models"]] == read(
        live, bench, [f"kalman.residual.{n}" for n in names], tick
    )
    before = [1 / 3] * 3 if tick == 0 else read(live, bench, [f"kalman.probability.{n}" for n in names], tick - 1)
    weights = []
    for model, prior in zip(found["models"], before, strict=True):
        assert model["prior"] == pytest.approx(prior)
        psi = model["covariance_um2"]
        assert psi > NOISE_UM**2  # the covariance of a prediction is more than that of the sensor
        density = math.exp(-(model["residual_um"] ** 2) / (2 * psi)) / math.sqrt(2 * math.pi * psi)
        assert model["log_likelihood"] == pytest.approx(math.log(density))
        weights.append(prior * density)
    shares = [max(weight / sum(weights), 0.01) for weight in weights]
    for model, share in zip(found["models"], shares, strict=True):
        assert model["posterior"] == pytest.approx(share / sum(shares))
        assert model["recorded"] == pytest.approx(model["posterior"], abs=2e-4)


def test_a_sample_of_a_twin_is_explained_by_the_bank_of_the_twin(live):
    twins = {"other": {"diagnosers": {"kalman": {"assumed_noise_scale": 4.0}}}}
    bench = live.bench({**WATCHED, "twins": twins}, paused=True)
    live.command(bench["id"], "step", ticks=200)
    own, other = (
        live.http.get(f"{url(bench, name)}/explanation", params={"tick": 150}).json()["models"][0]["covariance_um2"]
        for name in ("kalman", "other:kalman")
    )
    assert other == pytest.approx(4 * own, rel=0.2)


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


@pytest.mark.parametrize(
    ("path", "field"),
    [
        ("nobody/explanation?tick=1", "diagnoser"),
        ("regions/explanation?tick=1", "diagnoser"),
        ("kalman/explanation?tick=99999", "tick"),
        ("kalman/explanation?tick=-1", "tick"),
    ],
)
def test_what_cannot_be_explained_is_named(live, path, field):
    bench = live.bench(WATCHED, paused=True)
    live.command(bench["id"], "step", ticks=10)
    answer = live.http.get(f"/api/v1/benches/{bench['id']}/diagnosers/{path}")
    assert answer.status_code == 422 and answer.json()["error"]["field"] == field


def test_aliases_need_tones_and_a_list(live):
    bench = live.bench({**WATCHED, "reference": {"kind": "prbs", "amplitude_v": 10.0}}, paused=True)
    answers = [
        live.http.post(f"{url(bench)}/aliases", json={}),
        live.http.post(f"{url(bench)}/aliases", json={"hypotheses": [{"name": "one", "mass": -1}, {"name": "two"}]}),
        live.http.post(f"{url(bench, 'regions')}/aliases", json={}),
    ]
    assert [answer.json()["error"]["field"] for answer in answers] == ["tones", "hypotheses.0.mass", "diagnoser"]
