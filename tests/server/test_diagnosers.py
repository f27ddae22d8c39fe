"""Data of a live bench about its diagnosers: one sample explained, aliases, operations."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest
from scipy.stats import multivariate_normal

M, B, K, F = 2.2090e-10, 7.09e-7, 0.0538, -6.375e-9
BENCH = {
    "schema": 1,
    "id": "aliases",
    "sample_rate_khz": 50,
    "device": {"id": "ch3", "force_n_per_v": 6.375e-9, "bias_v": 6.0},
    "plant": {"model": "linear", "drive_noise_v": 0.01, "thermal_noise": False},
    "reference": {"kind": "sine", "amplitude_v": 10.0, "frequency_hz": 2000.0},
    "controller": {"kind": "open_loop"},
    "sensor": {"kind": "ideal", "noise_um": 0.05},
}
WEIGHING = ["mmae", "imm", "reseed", "lock_in", "arx_bank", "free_banks", "reference_banks", "anchored"]


def bench(live, ticks=0, **changed):
    made = live.bench({**BENCH, **changed}, paused=True)
    if ticks:
        live.command(made["id"], "step", ticks=ticks)
    return f"/api/v1/benches/{made['id']}", made["id"]


def normal(residual, covariance):
    return multivariate_normal.pdf(residual, cov=covariance) if covariance else 0.0


def test_a_sample_of_two_displacements_is_explained_as_bayes_has_it(live):
    """The covariance is of both residuals at once; the winner is raised by the least evidence that counts."""
    vague = {
        "kind": "axes_bank",
        "sensor_noise_um": 0.01,
        "drive_noise": 20.0,
        "sense_noise": 2.0,
        "rate_std_dps": 3e4,
        "rate_walk_dps_rt_s": 1e6,
    }
    made = live.bench(
        {
            "schema": 1,
            "id": "axes",
            "device": {"id": "gyro-a"},
            "plant": {"model": "gyroscope", "initial_x_um": 1.0},
            "rate": {"kind": "constant", "deg_per_s": 100.0},
            "controller": {"kind": "force_to_rebalance"},
            "sensor": {"kind": "pick_off", "noise_pm_rthz": 1.0},
            "diagnosers": {"bank": vague, "slow": {**vague, "every": 3}},
        },
        paused=True,
    )
    live.command(made["id"], "step", ticks=900)
    live.command(made["id"], fault="quadrature", severity=500.0)
    live.command(made["id"], "step", ticks=100)
    moved = 0.0
    for name, turns in (("bank", 1), ("slow", 3)):
        for tick in (9, 12, 15, 901, 999):
            path = f"/api/v1/benches/{made['id']}/diagnosers/{name}/explain"
            found = live.http.get(path, params={"tick": tick}).json()
            assert found["residuals"] == ["residual_x", "residual_y"] and found["tick"] == tick - tick % turns
            models = found["models"]
            logs = [multivariate_normal.logpdf(m["residual_um"], cov=m["covariance_um2"]) for m in models]
            assert [m["log_likelihood"] for m in models] == pytest.approx(logs, rel=1e-9)
            weights = [math.exp(log - max(logs)) * m["prior"] for log, m in zip(logs, models, strict=True)]
            lifted = [max(weight / sum(weights), found["floor"]) for weight in weights]
            expected = [weight / sum(lifted) for weight in lifted]
            assert [m["posterior"] for m in models] == pytest.approx(expected, abs=1e-9)
            assert [m["recorded"] for m in models] == pytest.approx(expected, abs=1e-3), (name, tick)
            assert any(abs(m["covariance_um2"][0][1]) > 0.0 for m in models)
            squares = [np.dot(m["residual_um"], np.linalg.solve(m["covariance_um2"], m["residual_um"])) for m in models]
            assert [m["missed_sigma"] for m in models] == pytest.approx(np.sqrt(squares), rel=1e-3)
            assert found["gain_units"] == ["1", "1", "1/ms", "1/ms", "deg/s/um"]
            assert all(np.shape(m["gain"]) == (5, 2) for m in models)
            moved += max(abs(m["posterior"] - m["prior"]) for m in models)
    assert moved > 0.01


def test_a_sample_is_explained_as_bayes_has_it(live):
    path, key = bench(live, 400, diagnosers={name: {"kind": name} for name in WEIGHING})
    live.command(key, fault="added_mass", severity=0.05)
    live.command(key, "step", ticks=30)
    for name in WEIGHING:
        for tick in (0, 3, 250, 405, 410, 429):
            answer = live.http.get(f"{path}/diagnosers/{name}/explain", params={"tick": tick})
            assert answer.status_code == 200, answer.text
            found = answer.json()
            assert found["tick"] == tick and found["time_ms"] == pytest.approx(0.02 * tick)
            assert found["evidence"] == (r"-\frac{T_k}{2W}" if name == "lock_in" else "")
            models = found["models"]
            assert [model["name"] for model in models][:2] == ["healthy", "m+5"]
            assert sum(model["prior"] for model in models) == pytest.approx(1.0, abs=1e-5)
            if tick == 0:
                continue  # nothing has been driven yet: the sample was no evidence
            assert found["residuals"] == ["residual"]
            filtered = name in ("mmae", "imm", "reseed", "lock_in")
            assert found["gain_units"] == (["1", "1/ms"] if filtered else [])
            for model in models:
                (r,), psi = model["residual_um"], model["covariance_um2"]
                if filtered:
                    assert model["gain"][0][0] == pytest.approx(1.0 - 0.05**2 / psi[0][0], rel=1e-3)
                if name != "lock_in":  # it is judged by what of the residuals is at the tone
                    assert model["missed_sigma"] == pytest.approx(abs(r) / math.sqrt(psi[0][0]), rel=1e-3)
            density = [normal(model["residual_um"], model["covariance_um2"]) for model in models]
            if not found["evidence"]:  # the normal density
                assert [math.exp(model["log_likelihood"]) for model in models] == pytest.approx(density)
                weights = [d * model["prior"] for d, model in zip(density, models, strict=True)]
                lifted = [max(weight / sum(weights), found["floor"]) for weight in weights]
                expected = [weight / sum(lifted) for weight in lifted]
                assert [model["posterior"] for model in models] == pytest.approx(expected, abs=1e-9)
            recorded = [model["recorded"] for model in models]
            assert [model["posterior"] for model in models] == pytest.approx(recorded, abs=2e-4), (name, tick)
    assert live.http.get(f"{path}/diagnosers/mmae/explain").json()["tick"] == 429


def test_the_sample_where_a_verdict_turned_is_found(live):
    """Against the verdicts themselves, as the bench gives them."""
    path, key = bench(live, 400, diagnosers={"mmae": {"kind": "mmae", "every": 4}})
    live.command(key, fault="added_mass", severity=0.05)
    live.command(key, "step", ticks=200)
    trace = live.http.get(f"{path}/trace", params={"signals": "mmae.winner", "format": "csv"}).text.splitlines()
    winners = [int(float(line.split(",")[-1])) for line in trace if line[:1].isdigit()]
    assert len(winners) == 600
    turns = [i for i in range(1, 600) if winners[i] != winners[i - 1]]
    assert turns and turns[-1] > 400 and winners[-1] == 1
    for tick in (turns[-1] - 1, turns[-1], 599):
        found = live.http.get(f"{path}/diagnosers/mmae/turn", params={"tick": tick}).json()
        before = [turn for turn in turns if turn <= tick]
        names = ["healthy", "m+5", "m+10", "k+5", "k+10", "b+30"]
        expected = (
            {"tick": before[-1], "before": names[winners[before[-1] - 1]]} if before else {"tick": None, "before": ""}
        )
        assert found == {**expected, "since": 0}
    early = live.http.get(f"{path}/diagnosers/mmae/turn", params={"tick": turns[0] - 1}).json()
    assert early == {"tick": None, "before": "", "since": 0}
    for params, field in (({"tick": 5000}, "tick"), ({"tick": -1}, "tick")):
        answer = live.http.get(f"{path}/diagnosers/mmae/turn", params=params)
        assert answer.status_code == 422 and answer.json()["error"]["field"].endswith(field)


def test_a_seldom_bank_and_that_of_a_twin_are_explained(live):
    seldom = {"kalman": {"kind": "mmae", "every": 5}}
    path, _ = bench(live, 200, diagnosers=seldom, twins={"other": {"diagnosers": {"own": {"kind": "imm"}}}})
    found = live.http.get(f"{path}/diagnosers/kalman/explain", params={"tick": 137}).json()
    assert found["tick"] == 135
    twin = live.http.get(f"{path}/diagnosers/other:own/explain", params={"tick": 137}).json()
    assert twin["kind"] == "imm" and twin["tick"] == 137
    for account in (found, twin):
        for model in account["models"]:
            assert model["posterior"] == pytest.approx(model["recorded"], abs=2e-4)


def test_what_cannot_be_explained_is_refused(live):
    both = {"kalman": {"kind": "mmae"}, "consistency": {"kind": "consistency"}}
    (path, _), (fresh, _) = bench(live, 50, diagnosers=both), bench(live, diagnosers=both)
    for where, name, params, field, word in (
        (path, "kalmann", {}, "name", "unknown diagnoser"),
        (path, "consistency", {"tick": 10}, "name", "sample by sample"),
        (path, "kalman", {"tick": 5000}, "tick", "not kept"),
        (path, "kalman", {"tick": -1}, "tick", ""),
        (fresh, "kalman", {}, "tick", ""),  # it has not begun
    ):
        answer = live.http.get(f"{where}/diagnosers/{name}/explain", params=params)
        assert answer.status_code == 422, answer.text
        error = answer.json()["error"]
        assert error["field"].endswith(field) and word in error["message"]


def response(m=1.0, k=1.0, b=1.0, f=2000.0, volts=10.0):
    w = 2 * math.pi * f
    return 1e6 * F * volts / complex(k * K - m * M * w * w, b * B * w)


def test_aliases_at_the_frequency_of_the_drive(live):
    share = M * (2 * math.pi * 2000.0) ** 2 / K
    alias = {"name": "alias", "stiffness": 1.0 - 0.05 * share}
    hypotheses = [{"name": "healthy"}, {"name": "m+5", "mass": 1.05}, {"name": "b+30", "damping": 1.3}, alias]
    path, _ = bench(live, diagnosers={"kalman": {"kind": "mmae", "hypotheses": hypotheses}})
    found = live.http.get(f"{path}/diagnosers/kalman/aliases").json()
    assert found["tones_hz"] == [2000.0]
    assert found["stiffness_per_mass"] == pytest.approx(-share, rel=1e-9)
    by_name = {item["name"]: item for item in found["responses"]}
    for name, factors in {"healthy": {}, "m+5": {"m": 1.05}, "b+30": {"b": 1.3}}.items():
        assert by_name[name]["amplitudes_um"][0] == pytest.approx(abs(response(**factors)), rel=1e-9)
        assert by_name[name]["phases_deg"][0] == pytest.approx(math.degrees(cmath.phase(response(**factors))))
    assert by_name["m+5"]["equivalents"]["stiffness"] == pytest.approx(1 - 0.03242, abs=1e-5)
    assert by_name["alias"]["equivalents"]["mass"] == pytest.approx(1.05, abs=1e-9)
    assert by_name["healthy"]["equivalents"] == {} == by_name["b+30"]["equivalents"]
    first = found["pairs"][0]
    assert {first["first"], first["second"]} == {"m+5", "alias"} and first["coincident"]
    assert not any(pair["coincident"] for pair in found["pairs"][1:])
    apart = next(p for p in found["pairs"] if {p["first"], p["second"]} == {"healthy", "b+30"})
    assert apart["distance_um"] == pytest.approx(abs(response() - response(b=1.3)), rel=1e-9)
    assert apart["distance_um"] == pytest.approx(0.367, rel=5e-3)
    # at another frequency they part, and a second tone parts them too
    other = live.http.get(f"{path}/diagnosers/kalman/aliases", params={"frequency_hz": 1000.0}).json()
    assert not any(pair["coincident"] for pair in other["pairs"])
    tones = [{"frequency_hz": 2000.0}, {"frequency_hz": 1000.0}]
    path, _ = bench(
        live,
        diagnosers={"kalman": {"kind": "mmae", "hypotheses": hypotheses}},
        reference={"kind": "multi_sine", "amplitude_v": 7.0, "tones": tones},
    )
    both = live.http.get(f"{path}/diagnosers/kalman/aliases").json()
    assert both["tones_hz"] == [2000.0, 1000.0] and not any(pair["coincident"] for pair in both["pairs"])
    assert all(item["equivalents"] == {} for item in both["responses"] if item["name"] in ("m+5", "alias"))


def test_a_list_of_hypotheses_is_mapped_before_any_bench_has_it(live):
    body = {
        "device": {"id": "ch3", "force_n_per_v": 6.375e-9, "bias_v": 6.0},
        "hypotheses": [{"name": "healthy"}, {"name": "m+5", "mass": 1.05}, {"name": "k-3", "stiffness": 0.96758}],
        "tones": [{"amplitude": 10.0, "frequency": 2000.0}],
        "noise_um": 0.05,
    }
    found = live.http.post("/api/v1/theory/aliases", json=body).json()
    assert [p["coincident"] for p in found["pairs"]] == [True, False, False]
    assert found["responses"][0]["amplitudes_um"] == [pytest.approx(abs(response()))]
    for wrong, field in (
        ({"hypotheses": [{"name": "healthy"}]}, "hypotheses"),
        ({"hypotheses": [{"name": "a"}, {"name": "a"}]}, "hypotheses"),
        ({"hypotheses": [{"name": "a"}, {"name": "b", "mass": 0.0}]}, "hypotheses.1.mass"),
        ({"tones": []}, "tones"),
        ({"device": {"id": "double-integrator"}}, "device.id"),
    ):
        answer = live.http.post("/api/v1/theory/aliases", json={**body, **wrong})
        assert answer.status_code == 422 and answer.json()["error"]["field"].endswith(field), answer.text


def test_at_rest_only_stiffness_and_gain_show(live):
    hypotheses = [{"name": "healthy"}, {"name": "m+5", "mass": 1.05}, {"name": "k+5", "stiffness": 1.05}]
    path, _ = bench(
        live,
        diagnosers={"kalman": {"kind": "mmae", "hypotheses": hypotheses}},
        reference={"kind": "constant", "amplitude_v": 10.0},
    )
    found = live.http.get(f"{path}/diagnosers/kalman/aliases").json()
    assert found["tones_hz"] == [0.0]
    pairs = {frozenset((p["first"], p["second"])): p for p in found["pairs"]}
    assert pairs[frozenset(("healthy", "m+5"))]["coincident"]
    assert not pairs[frozenset(("healthy", "k+5"))]["coincident"]
    apart = 10.0 * 1e6 * abs(F) / K * (1 - 1 / 1.05)
    assert pairs[frozenset(("healthy", "k+5"))]["distance_um"] == pytest.approx(apart)
    assert found["responses"][2]["equivalents"] == {"gain": pytest.approx(1 / 1.05)}


def test_a_reference_without_tones_asks_for_one(live):
    path, _ = bench(live, diagnosers={"kalman": {"kind": "mmae"}}, reference={"kind": "prbs", "amplitude_v": 1.0})
    answer = live.http.get(f"{path}/diagnosers/kalman/aliases")
    assert answer.status_code == 422 and answer.json()["error"]["field"] == "frequency_hz"
    assert live.http.get(f"{path}/diagnosers/kalman/aliases", params={"frequency_hz": 2000.0}).status_code == 200


def test_operations_against_a_board(live):
    banks = {"kalman": {"kind": "mmae"}, "steady": {"kind": "mmae", "form": "steady"}}
    path, _ = bench(live, 300, diagnosers=banks)
    before = live.http.get(f"{path}/digest").json()
    found = live.http.get(f"{path}/flops", params={"board_mflops": 20.0}).json()
    loads = {load["name"]: load for load in found["loads"]}
    # an update of two states with covariance is some 40 to 60 operations, one with fixed gains about 20
    assert 30 <= loads["kalman"]["per_model"] <= 110 and 10 <= loads["steady"]["per_model"] <= 40
    for load in loads.values():
        cost = load["operations"] + 20.0 * load["functions"]
        assert load["flops_per_second"] == pytest.approx(cost * 50e3)
        assert load["share"] == pytest.approx(cost * 50e3 / 20e6)
    assert loads["kalman"]["overrun"] and loads["kalman"]["models_that_fit"] < 6
    rich = live.http.get(f"{path}/flops", params={"board_mflops": 1000.0}).json()
    assert not any(load["overrun"] for load in rich["loads"])
    assert live.http.get(f"{path}/digest").json() == before
    assert live.http.get(f"{path}/flops", params={"board_mflops": 0.0}).status_code == 422
