"""The device designer by REST, against the formulas of chapter 1."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from typer.testing import CliRunner

from core.device.catalogue import device
from server.cli.main import app

EPSILON_0 = 8.8541878128e-12


def ask(live, what, **body):
    answer = live.http.post(f"/api/v1/devices/{what}", json=body)
    assert answer.status_code == 200, answer.text
    return answer.json()


def figures(live, **body):
    return {entry["name"]: entry for entry in ask(live, "evaluate", **body)["figures"]}


def test_every_figure_has_its_unit_and_equation_and_errata_say_why(live):
    found = figures(live, device={"id": "lcr-350"})
    assert list(found) == [
        "mass_kg",
        "stiffness_n_m",
        "damping_ns_m",
        "f0_hz",
        "quality_factor",
        "static_gain_um_per_v",
        "force_n_per_v",
        "pull_in_v",
    ]
    for entry in found.values():
        assert entry["unit"] and entry["equation"]["latex"] and entry["equation"]["source"][0].isdigit()
        assert (entry["equation"]["printed"] is None) == (entry["equation"]["why"] is None)
    assert found["stiffness_n_m"]["equation"]["printed"]


def test_figures_follow_the_drawing(live):
    # trusses as wide as anything make guided beams: k = 24 E I / L^3 with I = t w^3 / 12 (limit of 1.3.4)
    drawn = {"truss_width_um": 400.0, "beam_length_um": 200.0, "fingers": 50}
    found = figures(live, device={"id": "lcr-350", "geometry": drawn})
    beam = (2.0 - 2 * 0.23835) * 1e-6
    stiffness = 2 * 164e9 * 2e-6 * (beam / 200e-6) ** 3
    assert found["stiffness_n_m"]["value"] == pytest.approx(stiffness, rel=1e-4)
    assert found["force_n_per_v"]["value"] == pytest.approx(4 * 50 * EPSILON_0 * 2.0 / 2.1 * 10.0, rel=1e-9)
    mass, damping = found["mass_kg"]["value"], found["damping_ns_m"]["value"]
    assert found["f0_hz"]["value"] == pytest.approx(math.sqrt(stiffness / mass) / (2 * math.pi), rel=1e-4)
    assert found["quality_factor"]["value"] == pytest.approx(math.sqrt(stiffness * mass) / damping, rel=1e-4)
    gain = found["static_gain_um_per_v"]["value"]
    assert gain == pytest.approx(-1e6 * found["force_n_per_v"]["value"] / stiffness, rel=1e-4)


def test_pull_in_is_the_reference_figure_and_goes_with_the_root_of_the_force(live):
    """V^2 dC/dx is the same at pull-in for the same beams: a device without a drawing has the beams of LCR-350."""
    assert figures(live, device={"id": "lcr-350"})["pull_in_v"]["value"] == pytest.approx(28.08, rel=5e-3)
    drawn, ch3 = (figures(live, device={"id": name}) for name in ("lcr-350", "ch3"))
    ratio = ch3["pull_in_v"]["value"] / drawn["pull_in_v"]["value"]
    gradients = device({"id": "lcr-350"}).capacitance_gradient / device({"id": "ch3"}).capacitance_gradient
    assert ratio == pytest.approx(math.sqrt(gradients), rel=1e-3)


def test_the_environment_counts(live):
    room = figures(live, device={"id": "ch3"})
    thin = figures(live, device={"id": "ch3"}, environment={"pressure_pa": 100.0, "temperature_k": 400.0})
    assert thin["quality_factor"]["value"] > 10 * room["quality_factor"]["value"]
    # -63 ppm/K of Young's modulus
    ratio = thin["stiffness_n_m"]["value"] / room["stiffness_n_m"]["value"]
    assert ratio == pytest.approx(1 - 63e-4, rel=1e-9)


def test_a_narrower_beam_is_softer_by_the_cube(live):
    # 0.1 um per edge off beams and trusses of one width keeps alpha: k ~ w^3 (1.4.2)
    same = {"beam_width_um": 5.0, "truss_width_um": 5.0, "beam_bias_um": 0.0}
    found = ask(live, "evaluate", device={"id": "lcr-350", "geometry": same})["sensitivities"]["beam_bias_um"]
    assert found["stiffness_n_m"] == pytest.approx(100 * ((1 - 0.2 / 5) ** 3 - 1), abs=1e-9)
    # 0.2 um off a beam of 0.1 um leaves nothing, so that step is not offered
    thin = {**same, "beam_width_um": 0.1, "truss_width_um": 0.1}
    assert "beam_bias_um" not in ask(live, "evaluate", device={"id": "lcr-350", "geometry": thin})["sensitivities"]


def test_bode_is_the_oscillator_and_the_band_of_given_values_is_its_extreme_devices(live):
    found = ask(live, "bode", device={"id": "ch3"}, start_hz=100.0, stop_hz=20_000.0, points=101)
    m, b, k = 2.2090e-10, 7.09e-7, 0.0538
    w = 2 * np.pi * np.array(found["frequency_hz"])
    h = k / (k - m * w**2 + 1j * b * w)
    assert found["magnitude_db"]["nominal"] == pytest.approx(20 * np.log10(abs(h)), abs=1e-9)
    assert found["phase_deg"]["nominal"] == pytest.approx(np.degrees(np.angle(h)), abs=1e-9)
    # statically only k counts: 1 / 0.95 and 1 / 1.05
    assert found["magnitude_db"]["high"][0] == pytest.approx(-20 * math.log10(0.95), abs=0.02)
    assert found["magnitude_db"]["low"][0] == pytest.approx(-20 * math.log10(1.05), abs=0.02)


def test_the_band_of_a_drawing_is_that_of_devices_drawn_from_the_process(live):
    found = ask(live, "bode", device={"id": "lcr-350"}, start_hz=1.0, stop_hz=200_000.0, points=60, seed=4)
    db = {name: np.array(values) for name, values in found["magnitude_db"].items()}
    assert np.all(db["low"] < db["nominal"]) and np.all(db["nominal"] < db["high"])
    # far above resonance x / v = F / m w^2: thickness cancels, so the band is narrower than the static band, where k
    # varies
    width = db["high"] - db["low"]
    assert width[-1] < 0.5 * width[0]
    again = ask(live, "bode", device={"id": "lcr-350"}, start_hz=1.0, stop_hz=200_000.0, points=60, seed=4)
    assert again == found


def test_a_device_drawn_from_the_process_is_the_same_for_the_same_seed(live):
    first, again, other = (ask(live, "spread", device={"id": "lcr-350"}, seed=seed) for seed in (7, 7, 8))
    assert first == again and first["geometry"] != other["geometry"]
    for name, sigma in first["assumed"].items():
        nominal = {"beam_bias_um": 0.23835, "comb_bias_um": 0.05, "thickness_um": 2.0, "film_gap_um": 1.9987}
        assert abs(first["geometry"][name] - nominal.get(name, 164.0)) <= 3 * sigma
    # k ~ w^3 with 0.1 um of deviation per width of 1.523 um, and E, t: about a fifth
    assert 17 < first["statistics"]["stiffness_n_m"]["variation_pct"] < 23
    drawn = figures(live, device={"id": "lcr-350", "geometry": first["geometry"]})
    spread = first["statistics"]["stiffness_n_m"]
    assert 0.7 * spread["p01"] < drawn["stiffness_n_m"]["value"] < 1.4 * spread["p99"]


def test_a_transfer_function_has_the_figures_that_mean_something_without_units(live):
    for name, has in (
        ("double-integrator", {}),
        ("unstable-first-order", {"static_gain_um_per_v": -5.0}),
        ("second-order-gain", {"f0_hz": 1 / (2 * math.pi), "static_gain_um_per_v": 1.0}),
    ):
        found = {key: entry["value"] for key, entry in figures(live, device={"id": name}).items()}
        assert found == pytest.approx(has), name


def test_a_gyroscope_has_figures_of_both_axes(live):
    found = {figure["name"]: figure["value"] for figure in ask(live, "evaluate", device={"id": "gyro-c"})["figures"]}
    assert found["gyro.mode_hz.2"] == pytest.approx(3978.45, abs=0.01)
    assert found["gyro.scale_pm_per_dps"] == pytest.approx(258.6, rel=1e-3)
    assert found["gyro.arw_deg_per_rt_h"] == pytest.approx(0.0107, abs=5e-5)
    assert "static_gain_um_per_v" not in found and "pull_in_v" not in found


def test_a_drawn_gyroscope_follows_its_drawing(live):
    """Beams of one length along both axes, all else alike, match the modes."""
    found = ask(live, "evaluate", device={"id": "gyro-lcr-350", "drawn_gyroscope": {"sense_beam_length_um": 350.0}})
    values = {figure["name"]: figure["value"] for figure in found["figures"]}
    assert values["gyro.stiffness_x_n_m"] == values["gyro.stiffness_y_n_m"]
    assert values["gyro.split_hz"] == pytest.approx(0.0, abs=1e-3)
    resonator = figures(live, device={"id": "lcr-350"})
    assert values["gyro.stiffness_x_n_m"] == pytest.approx(2 * resonator["stiffness_n_m"]["value"], rel=1e-12)
    assert values["gyro.force_x_nn_per_v2"] * 10.0 == pytest.approx(
        1e9 * resonator["force_n_per_v"]["value"], rel=1e-12
    )
    assert found["geometry"]["fingers"] == 87 and found["sensitivities"] == {}
    few = ask(live, "evaluate", device={"id": "gyro-lcr-350", "drawn_gyroscope": {"sense_fingers": 29}})["metrics"]
    assert few["gyro.sense_ff_per_um"] == pytest.approx(values["gyro.sense_ff_per_um"] / 3, rel=1e-12)


@pytest.mark.parametrize("stators", [{"bias_v": 0}, {"opposite_bias_v": 10.0}])
def test_without_a_force_the_response_is_that_of_the_mechanics(live, stators):
    """Displacement per volt over the static value does not depend on the bias: its limit is the same at none."""
    found, usual = (ask(live, "bode", device={"id": "lcr-350", **own}) for own in (stators, {}))
    assert found["magnitude_db"] == usual["magnitude_db"] and found["static_gain_um_per_v"] == 0.0
    assert usual["static_gain_um_per_v"] != 0.0
    drawn = ask(live, "spread", device={"id": "lcr-350", **stators})["statistics"]
    assert "force" not in drawn and drawn["f0_hz"]["variation_pct"] > 0.0


def test_devices_are_drawn_in_their_environment(live):
    design = {"device": {"id": "lcr-350", "mass_kg": 3e-10}, "environment": {"pressure_pa": 1000.0}}
    nominal = figures(live, **design)
    drawn = ask(live, "spread", **design, seed=2, draws=4000)["statistics"]
    # the median of a nearly symmetric spread; 3 to 10 % apart over sqrt(4000) devices
    for name in ("mass_kg", "damping_ns_m", "stiffness_n_m", "quality_factor"):
        assert drawn[name]["p50"] == pytest.approx(nominal[name]["value"], rel=0.02), name


REFUSED = [
    ("evaluate", {"device": {"id": "none-such"}}, "device.id", "unknown"),
    ("evaluate", {"device": {"id": "lcr-350", "geometry": {"fingers": 0}}}, "device.geometry.fingers", ">= 1"),
    (
        "evaluate",
        {"device": {"id": "lcr-350", "geometry": {"beam_bias_um": 1.0}}},
        "device.geometry",
        "nothing is left of the beams",
    ),
    (
        "evaluate",
        {"device": {"id": "lcr-350", "geometry": {"overlap_um": 61.0}}},
        "device.geometry",
        "overlap_um must be <= finger_length_um",
    ),
    (
        "evaluate",
        {"device": {"id": "lcr-350", "geometry": {"comb_bias_um": -1.0}}},
        "device.geometry",
        "the fingers touch",
    ),
    ("evaluate", {"device": {}, "environment": {"pressure_pa": -1}}, "environment.pressure_pa", ">= 0.01"),
    ("evaluate", {"gadget": {}}, "gadget", "unknown field"),
    ("evaluate", {"device": {"id": [1]}}, "device.id", "unknown"),
    ("evaluate", {"device": {"stiffness_n_m": 1e300}}, "device.stiffness_n_m", "<= 1000000000"),
    ("bode", {"device": {"id": "double-integrator"}}, "device.id", "without mass or stiffness"),
    ("bode", {"device": {"id": "second-order-gain"}}, "device.id", "without mass or stiffness"),
    ("bode", {"device": {"id": "gyro-c"}}, "device.id", "two axes"),
    ("bode", {"device": {"id": "gyro-lcr-350"}}, "device.id", "two axes"),
    ("spread", {"device": {"id": "ch3"}}, "device.id", "no drawing"),
    ("spread", {"device": {"id": "gyro-lcr-350"}}, "device.id", "no drawing of a resonator"),
    (
        "evaluate",
        {"device": {"id": "lcr-350", "drawn_gyroscope": {"sense_fingers": 88}}},
        "device",
        "88 fingers along y take 698\u00a0µm of an arm of 690\u00a0µm",
    ),
    ("bode", {"points": 100_000}, "points", "2000"),
]


def test_what_cannot_be_built_is_refused_in_one_line(live):
    for what, body, field, words in REFUSED:
        answer = live.http.post(f"/api/v1/devices/{what}", json=body)
        assert answer.status_code == 422, answer.text
        error = answer.json()["error"]
        assert error["field"] == field and words in error["message"], error


def test_a_device_says_which_plants_suit_it_and_the_bench_agrees(live):
    devices = {entry["id"]: entry["plants"] for entry in live.http.get("/api/v1/devices").json()["devices"]}
    plants = {entry["id"]: entry["plant"] for entry in live.http.get("/api/v1/scenarios").json()["scenarios"]}
    for scenario in ("first-look", "gyro-first-look"):
        for name in ("ch4", "gyro-b", "unstable-first-order"):
            body = {"scenario": scenario, "set": {"device.id": name}, "paused": True}
            answer = live.http.post("/api/v1/benches", json=body)
            assert (answer.status_code == 201) == (plants[scenario] in devices[name]), answer.text
            if answer.status_code == 201:
                live.http.delete(f"/api/v1/benches/{answer.json()['id']}")
            else:
                assert "device" in answer.json()["error"]["message"]
    for name, suited in devices.items():
        of = device({"id": name})
        assert ("gyroscope" in suited) == (of.gyroscope is not None or of.drawn_gyroscope is not None)


def test_the_list_has_the_choices_of_fringing_and_the_limits_of_electrodes(live):
    listed = live.http.get("/api/v1/devices").json()
    assert listed["fringing"]["type"] == "choice" and listed["fringing"]["choices"] == ["grounded_plane", "free"]
    comb, tuning = ({card["name"]: card for card in listed[name]} for name in ("comb", "tuning"))
    assert list(comb) == ["bias_v", "fingers", "thickness_um", "gap_um"]
    assert (comb["fingers"]["type"], comb["fingers"]["minimum"], comb["fingers"]["maximum"]) == ("integer", 1, 100_000)
    assert (comb["gap_um"]["type"], comb["gap_um"]["minimum"], comb["gap_um"]["default"]) == ("number", 1e-3, None)
    assert list(tuning) == ["plates", "length_um", "thickness_um", "gap_um"]
    assert [card["default"] for card in tuning.values()] == [20, 400.0, 60.0, 3.0]


def test_fringing_and_electrodes_are_worked_out_like_any_number_of_a_device(live):
    plain, above = ({"id": "lcr-350"}, {"id": "lcr-350", "fringing": "grounded_plane"})
    factor = figures(live, device=above)["fringing_factor"]["value"]
    force = (
        figures(live, device=above)["force_n_per_v"]["value"] / figures(live, device=plain)["force_n_per_v"]["value"]
    )
    assert force == pytest.approx(factor, rel=1e-12) and factor == pytest.approx(1.118, rel=5e-3)
    comb = {"fingers": 100, "thickness_um": 60.0, "gap_um": 3.0}
    found = figures(live, device={"id": "gyro-c", "electrodes": {"drive": comb, "tuning": {}}})
    # 4 n eps t/g, and 2 eps A/g^3
    assert found["gyro.force_x_nn_per_v2"]["value"] == pytest.approx(4e9 * 100 * EPSILON_0 * 60 / 3, rel=1e-12)
    softening = 2 * EPSILON_0 * 20 * 400e-6 * 60e-6 / (3e-6) ** 3
    assert found["gyro.softening_n_m_per_v2"]["value"] == pytest.approx(softening, rel=1e-9)


def test_the_command_line_runs_devices_with_fringing_and_with_volts():
    def ran(name, **values):
        changes = [word for path, value in values.items() for word in ("--set", f"{path.replace('__', '.')}={value}")]
        answer = CliRunner().invoke(app, ["run", name, "--set", "duration_ms=1", *changes, "--json"])
        return json.loads(answer.stdout)["metrics"]

    assert ran("ch1-fringing", device__fringing="free")["device.fringing_factor"] == pytest.approx(2.065, rel=5e-3)
    comb = "{fingers=100,thickness_um=60.0,gap_um=3.0}"
    combs = {"device__electrodes__drive": comb, "device__electrodes__sense": comb}
    found = ran("gyro-feed-through", drive__by="volts", **combs)
    assert found["gyro.force_x_nn_per_v2"] == pytest.approx(4e9 * 100 * EPSILON_0 * 60 / 3, rel=1e-12)
