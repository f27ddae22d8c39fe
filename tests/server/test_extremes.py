"""Numbers that are valid and far from anything built: refused with their field, or computed with; never a failure."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.registry import catalog
from server.bench import description
from tests.server.test_bad_input import check

EXTREMES = [5e-324, -5e-324, 1e-310, 2.3e-308, 1e-200, 1e-60, -0.0, 1e30, 2**63, 1e100, 1e200, -1.7e308, 1.7e308]
PLACES = {
    "reference": ("reference", "kind"),
    "plant": ("plant", "model"),
    "sense": ("sensor", "kind"),
    "control": ("controller", "kind"),
    "identify": ("identifiers.mine", "kind"),
    "diagnose": ("diagnosers.mine", "kind"),
    "rate": ("rate", "kind"),
    "readout": ("readouts.mine", "kind"),
    "supervise": ("supervisor", "kind"),
}
"""The place of the blocks of a family in a scenario, and the field that chooses one."""


def parameters() -> list[tuple[str, str, str, bool]]:
    """List the numbers of all blocks: family, block, parameter, and whether it has axes."""
    return [
        (card.family, card.name, entry.name, bool(card.axes))
        for card in catalog()
        for entry in card.parameters
        if card.family in PLACES
        and isinstance(entry.default, int | float | None)
        and not isinstance(entry.default, bool)
    ]


SMALL = {"schema": 1, "id": "mine", "samples": 300, "device": {"id": "ch3"}}


AXES = {"schema": 1, "id": "mine", "samples": 300, "device": {"id": "gyro-a"}, "plant": {"model": "gyroscope_pair"}}


def values_of(family: str, name: str, parameter: str, value: float) -> dict[str, Any]:
    """What to write over a scenario."""
    place, key = PLACES[family]
    chosen: dict[str, Any] = {f"{place}.{key}": name, f"{place}.{parameter}": value}
    if family == "reference" and parameter not in ("amplitude_v", "amplitude_um"):
        chosen[f"{place}.amplitude_v"] = 5.0
    return chosen


def test_a_number_nothing_can_be_computed_from_is_refused(live: Any) -> None:
    for family, name, parameter, value in (
        ("reference", "sine", "frequency_hz", 5e-324),
        ("reference", "square", "frequency_hz", 1e-310),
        ("plant", "nonlinear", "slip_velocity_um_ms", 5e-324),
        ("plant", "planar", "stator_tip_um", 1e200),
        ("plant", "slaved_lateral", "ratio", 1e-200),
        ("control", "mrac_velocity", "zero", 5e-324),
        ("diagnose", "anchored", "sensor_noise_um", 1e-200),
        ("diagnose", "reference_banks", "assumed_noise_scale", 5e-324),
    ):
        body = {"scenario": SMALL, "set": values_of(family, name, parameter, value)}
        check(live.http.post("/api/v1/benches", json=body), 422, None, f"{PLACES[family][0]}.{parameter}", "size")
    assert live.http.get("/api/v1/benches").json() == {"benches": []}


@pytest.mark.parametrize("examples", [40, pytest.param(300, marks=pytest.mark.long)])
def test_every_parameter_at_its_extremes_is_refused_or_works(live: Any, examples: int) -> None:
    @settings(max_examples=examples)
    @given(st.sampled_from(parameters()), st.sampled_from(EXTREMES))
    def tried(parameter: tuple[str, str, str, bool], value: float) -> None:
        *place, has_axes = parameter
        body = {"scenario": AXES if has_axes else SMALL, "set": values_of(*place, value), "paused": True}
        made = live.http.post("/api/v1/benches", json=body)
        if made.status_code != 201:
            check(made, 422, None)
            return
        path = f"/api/v1/benches/{made.json()['id']}"
        assert live.command(made.json()["id"], "step_period").status_code in (200, 422)
        assert live.command(made.json()["id"], "step", ticks=20).status_code in (200, 422)
        for ending in ("", "/scenario", "/digest", "/trace?format=csv"):
            assert live.http.get(path + ending).status_code in (200, 422)
        assert "internal error" not in live.http.get(f"{path}/events").text
        assert live.http.delete(path).status_code == 204

    tried()


def test_a_bench_that_cannot_be_described_hides_no_other(live: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    broken, other = live.bench("first-look"), live.bench("first-look")

    def period(bench: Any) -> float:
        return 1.0 / (bench.id != broken["id"])

    monkeypatch.setattr(description, "period_of", period)
    listed = live.http.get("/api/v1/benches")
    assert [bench["id"] for bench in listed.json()["benches"]] == [other["id"]]
    assert live.http.delete(f"/api/v1/benches/{broken['id']}").status_code == 204


def test_a_bench_that_cannot_be_described_at_first_is_closed_again(live: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as patched:
        patched.setattr(description, "period_of", lambda _: 1.0 / 0.0)
        assert live.http.post("/api/v1/benches", json={"scenario": "first-look"}).status_code == 500
    assert live.http.get("/api/v1/benches").json() == {"benches": []}
