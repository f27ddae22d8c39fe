"""Thresholds: where a claim begins to hold, against closed forms."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from typing import Any

import pytest
from typer.testing import CliRunner

from core.errors import InputError
from scenarios.campaign.halving import MOST_TURNS, ROUNDS, Halving, Threshold, ThresholdGoal
from scenarios.campaign.threshold import ResultMemory, Search
from scenarios.schema import Scenario
from server.cli.main import app
from tests.lab import QUIET


def look(
    function: Callable[[float], float | None], bears_out: Callable[[float | None], bool], **given: Any
) -> tuple[Threshold, int]:
    """Halve over a function; return the result, and the number of rounds."""
    halving = Halving(ThresholdGoal(metric="f", path="x", **given), bears_out)
    while values := halving.next():
        halving.take([(value, function(value)) for value in values])
    return halving.found(), halving.rounds


def within(low: float, high: float) -> Callable[[float | None], bool]:
    return lambda measured: measured is not None and low <= measured <= high


def test_a_parabola_is_within_bounds_between_two_roots() -> None:
    found, rounds = look(lambda x: x * x, within(2.0, 3.0), low=0.0, high=4.0)
    first, second = found.turns
    assert (first.begins, second.begins) == (True, False)
    step = 4.0 / 16 / 2**ROUNDS
    assert first.value == pytest.approx(math.sqrt(2.0), abs=step)
    assert second.value == pytest.approx(math.sqrt(3.0), abs=step)
    assert first.value**2 >= 2.0
    assert second.value**2 <= 3.0
    for turn in found.turns:
        assert turn.high - turn.low == pytest.approx(step)
    assert found.words == "holds from 1.414 to 1.732"
    assert rounds == ROUNDS + 1
    assert [one.value for one in found.tried] == sorted(one.value for one in found.tried)


@pytest.mark.parametrize(
    ("bounds", "words"),
    [
        ((-1.0, 9.0), "holds everywhere from 0 to 8"),
        ((9.0, 10.0), "holds nowhere from 0 to 8"),
        ((0.0, 3.0), "holds up to 3"),
        ((math.pi, 9.0), "holds from 3.142 on"),
    ],
)
def test_where_it_holds_is_said(bounds: tuple[float, float], words: str) -> None:
    found, rounds = look(lambda x: x, within(*bounds), low=0.0, high=8.0)
    assert found.words == words
    assert (rounds == 1) == (not found.turns)


def test_every_place_that_the_grid_shows_is_told() -> None:
    found, _ = look(math.sin, within(0.0, 1.0), low=-1.0, high=10.0, points=23)
    assert [turn.begins for turn in found.turns] == [True, False, True, False]
    assert [turn.value for turn in found.turns] == pytest.approx([0.0, math.pi, 2 * math.pi, 3 * math.pi], abs=1e-3)
    assert found.words == "holds from " + "{:.4g} to {:.4g}, and from {:.4g} to {:.4g}".format(
        *(turn.value for turn in found.turns)
    )


def test_what_changes_everywhere_is_not_looked_at_for_ever() -> None:
    seen: list[int] = []
    halving = Halving(ThresholdGoal(metric="f", path="x", low=0.0, high=64.0, points=65), within(0.5, 1.5))
    while values := halving.next():
        seen.append(len(values))
        halving.take([(value, float(round(value * 1024) % 2 if value % 1 else value % 2)) for value in values])
    assert max(seen[1:]) <= MOST_TURNS
    assert len(seen) == ROUNDS + 1


def test_a_logarithmic_range_is_halved_by_its_logarithm() -> None:
    found, _ = look(lambda x: x, within(1.0, 1e9), low=1e-6, high=1e3, scale="log")
    assert found.turns[0].value == pytest.approx(1.0, rel=2e-3)
    ratios = [b.value / a.value for a, b in zip(found.tried[:3], found.tried[1:4], strict=True)]
    assert ratios == pytest.approx([10 ** (9 / 16)] * 3)


def test_a_figure_that_is_not_there_bears_nothing_out() -> None:
    found, _ = look(lambda x: None if x < 2.0 else x, within(0.0, 9.0), low=0.0, high=8.0)
    assert found.words == "holds from 2 on"


def amplitude_um(volts: float) -> float:
    """Amplitude of the ch3 device at 1 krad/s by its equation of motion, F = 1.619e-8 N/V."""
    mass, damping, stiffness, w = 2.2090e-10, 7.09e-7, 2 * 0.0269, 1000.0
    return 1e6 * 1.619e-8 * volts / math.hypot(stiffness - mass * w * w, damping * w)


def resonator() -> dict[str, Any]:
    return {
        **QUIET,
        "id": "threshold-test",
        "samples": 8000,
        "plant": {"model": "linear", "thermal_noise": False, "drive": "analogue"},
        "expect": [
            {"metric": "control.amplitude_um", "max": 2.0, "published": "at least 1", "published_range": [1.0, 9.0]},
            {"metric": "control.effort_rms_v", "max": 5.0},
        ],
    }


def test_the_amplitude_reaches_a_micrometre_at_the_voltage_of_the_equation() -> None:
    wanted = ThresholdGoal(metric="control.amplitude_um", path="reference.amplitude_v", low=0.5, high=10.0)
    search = Search(Scenario.load(resonator()), wanted, ResultMemory())
    assert search.run()
    found = Threshold.model_validate(search.kept)
    (turn,) = found.turns
    assert turn.begins
    assert amplitude_um(turn.value) == pytest.approx(1.0, rel=2e-3)
    assert search.done == search.total == len(found.tried) == 17 + ROUNDS
    assert search.progress == 1.0
    # the published value decides, and the expected value without a published one
    wanted = ThresholdGoal(metric="control.effort_rms_v", path="reference.amplitude_v", low=0.5, high=10.0)
    search = Search(Scenario.load(resonator()), wanted, ResultMemory())
    search.run()
    assert search.kept["turns"][0]["value"] == pytest.approx(5.0 * math.sqrt(2.0), rel=1e-2)  # no whole periods
    assert not search.kept["turns"][0]["begins"]


def test_what_was_computed_is_not_computed_again() -> None:
    table = ResultMemory()
    wanted = ThresholdGoal(metric="control.amplitude_um", path="reference.amplitude_v", low=0.5, high=10.0)
    first = Search(Scenario.load(resonator()), wanted, table)
    first.run()
    put: list[Any] = []
    table.put = put.append  # type: ignore[method-assign]
    again = Search(Scenario.load(resonator()), wanted, table)
    assert again.run()
    assert (again.kept, put) == (first.kept, [])


@pytest.mark.parametrize(
    ("given", "field"),
    [
        ({"metric": "control.nothing"}, "metric"),
        ({"path": "reference.nothing"}, "low"),
        ({"path": "sensor.noise_um", "low": -1.0}, "low"),
        ({"path": "sensor.noise_um", "high": 1e3}, "high"),
    ],
)
def test_what_cannot_be_looked_for_is_refused_by_name(given: dict[str, Any], field: str) -> None:
    usual = {"metric": "control.amplitude_um", "path": "reference.amplitude_v", "low": 0.5, "high": 10.0}
    with pytest.raises(InputError) as refused:
        Search(Scenario.load(resonator()), ThresholdGoal(**{**usual, **given}), ResultMemory())
    assert refused.value.field == field


def test_the_command_line_finds_it(tmp_path: Any) -> None:
    file = tmp_path / "one.toml"
    file.write_text(Scenario.load(resonator()).toml())
    run = CliRunner().invoke
    base = ["run", str(file), "--threshold", "control.amplitude_um", "--over"]
    answer = run(app, [*base, "reference.amplitude_v=0.5:10", "--json"])
    assert answer.exit_code == 0, answer.output
    found = Threshold.model_validate(json.loads(answer.stdout))
    assert amplitude_um(found.turns[0].value) == pytest.approx(1.0, rel=2e-3)
    plain = run(app, [*base, "reference.amplitude_v=0.5:10:log"])
    assert plain.stdout.strip().endswith("on")
    assert run(app, [*base, "reference.amplitude_v=0.1:0.2"]).exit_code == 1
    for over in ("reference.amplitude_v", "reference.amplitude_v=1", "x=2:1", "reference.amplitude_v=1:2:cubic"):
        refused = run(app, [*base, over])
        assert refused.exit_code == 2
        assert refused.stderr.count("\n") == 1
    assert run(app, ["run", str(file), "--over", "a=1:2"]).exit_code == 2
