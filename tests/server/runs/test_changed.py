"""The values that a run changes: told with the run, against its scenario in the library."""

from __future__ import annotations

import tomllib
from typing import Any

import pytest

from server.runs import jobs
from server.runs.changed import ChangedValue, differing, values_of

BASE = "/api/v1"
USUAL = """title = "Seven steps"
seed = 1
samples = 9000

[controller]
kind = "open_loop"

[sensor]
kind = "ideal"
noise_um = 0.05

[[events]]
at_sample = 2000
fault = "added_mass"
severity = 0.05

[events.profile]
kind = "ramp"
duration_ms = 10

[[events]]
at_sample = 3000
severity = 0.5

[[expect]]
metric = "control.rms_error_um"
max = 8
"""


def changes(own: str) -> list[tuple[str, Any, Any]]:
    found = differing(values_of(tomllib.loads(USUAL)), tomllib.loads(own))
    return [(one.path, one.before, one.value) for one in found]


@pytest.mark.parametrize(
    ("usual", "own", "change"),
    [
        ("severity = 0.5\n", "severity = 0.8\n", ("events.1.severity", 0.5, 0.8)),
        ("noise_um = 0.05", "noise_um = 0.15", ("sensors.ideal.noise_um", 0.05, 0.15)),
        ("duration_ms = 10", "duration_ms = 20", ("events.0.profile.duration_ms", 10, 20)),
        (
            "noise_um = 0.05",
            "noise_um = 0.15\n\n[sensors.ideal]\nnoise_um = 0.05",
            ("sensors.ideal.noise_um", 0.05, 0.15),
        ),
        ('kind = "open_loop"', 'kind = "pid"', ("controller.kind", "open_loop", "pid")),
        ("[sensor]", "[sensor]\ndelay_ticks = 3", ("sensors.ideal.delay_ticks", None, 3)),
        ("severity = 0.5\n", "severity = 0.5\n\n[[events]]\nat_sample = 4000\n", ("events.2.at_sample", None, 4000)),
        ("severity = 0.5\n", "severity = 0.5\nheal = ['damping']\n", ("events.1.heal", None, '["damping"]')),
    ],
)
def test_a_value_that_a_run_changes_is_told(usual: str, own: str, change: tuple[str, Any, Any]) -> None:
    assert changes(USUAL.replace(usual, own)) == [change]


@pytest.mark.parametrize(
    ("usual", "own"),
    [
        ("seed = 1", "seed = 7"),
        ("max = 8", "max = 9"),
        ('[sensor]\nkind = "ideal"\n', '[sensors.ideal]\nnoise_um = 0.3\n\n[sensor]\nkind = "ideal"\n'),
        ("severity = 0.5\n", "severity = 0.50\n"),
        ("Seven steps", "Mine"),
    ],
)
def test_seeds_claims_titles_and_other_ways_to_write_a_value_are_no_change(usual: str, own: str) -> None:
    assert USUAL.replace(usual, own) != USUAL and changes(USUAL.replace(usual, own)) == []


def test_several_values_come_in_the_order_of_the_scenario() -> None:
    own = USUAL.replace("0.05\n", "0.1\n").replace("severity = 0.1", "severity = 0.3")
    assert [path for path, *_ in changes(own)] == ["sensors.ideal.noise_um", "events.0.severity"]


def test_each_run_has_the_values_that_it_changes_and_they_are_computed_once(
    live: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    values = {"samples": 700, "sensor.noise_um": 0.07}
    made = live.http.post(f"{BASE}/runs", json={"scenario": "ch5-seven-step", "set": values, "seed": 3}).json()
    own = {"schema": 1, "id": "of-nobody", "samples": 100}
    other = live.http.post(f"{BASE}/runs", json={"scenario": own}).json()
    paths = {one["path"]: one["value"] for one in made["changed"]}
    assert paths.items() >= {("samples", 700), ("sensors.ideal.noise_um", 0.07)} and len(paths) == 2
    assert other["changed"] == []
    for run in (made, other):
        live.ended(run["id"])
        live.service.jobs._changed.pop(run["id"])  # as after a start of the server
        listed = live.http.get(f"{BASE}/runs?scenario={run['scenario_id']}").json()["runs"]
        assert next(one for one in listed if one["id"] == run["id"])["changed"] == run["changed"]

    def refuse(*_: object) -> list[ChangedValue]:
        raise AssertionError("it is known already")

    monkeypatch.setattr(jobs, "changed_values", refuse)
    assert live.http.get(f"{BASE}/runs/{made['id']}").json()["changed"] == made["changed"]
    assert live.http.get(f"{BASE}/runs?scenario=of-nobody").status_code == 200
