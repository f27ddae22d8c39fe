"""Diagnosers and identifiers in Python give the bits and the scores of the same ones on the board."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from core.board.hosted import Hosted
from core.board.outside import Observation, Sample
from core.board.parse import parse
from core.device.oscillator import held
from core.diagnose.hypothesis import Hypothesis, hypotheses_of
from core.elementary import exp
from core.errors import InputError
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import run
from scenarios.schema import Scenario
from tests.core.own.test_own_units import examples, with_unit
from tests.core.own.texts import FIT
from tests.lab import RICH, do, document, make, play

STORY: dict[str, Any] = {
    "samples": 1500,
    "events": [{"fault": "added_mass", "severity": 0.05, "at_sample": 600}],
    "diagnosers": {"mine": {"kind": "leaky_squares"}},
}
PAIR = [{"name": "healthy"}, {"name": "m+5", "mass": 1.05}]


class LeakySquares:
    """The diagnoser of docs/own-units.md, written in Python as its equation says."""

    def __init__(self, scenario: Scenario, hypotheses: list[Hypothesis], memory: float = 0.995) -> None:
        context = scenario.spec.context()
        device, noise = context.device, max(context.sensor_noise_um, 1e-3)
        self.models, self.memory, self.inverse, self.begun = [], memory, 1.0 / (noise * noise), 0
        for one in hypotheses:
            mass, damping = device.mass * one.mass, device.damping * one.damping
            *free, push1, push2 = held(mass, damping, device.stiffness * one.stiffness, context.dt_ms)
            force = device.force * one.gain
            self.models.append((*free, force * push1, force * push2))

    def __call__(self, x: Observation) -> list[float]:
        if x.begins:
            self.begun += 1
            self.state, self.cost = [(0.0, 0.0) for _ in self.models], [0.0 for _ in self.models]
        for i, (phi11, phi12, phi21, phi22, push1, push2) in enumerate(self.models):
            y, v = self.state[i]
            self.state[i] = phi11 * y + phi12 * v + push1 * x.applied, phi21 * y + phi22 * v + push2 * x.applied
            r = x.measured - self.state[i][0]
            self.cost[i] = self.memory * self.cost[i] + r * r * self.inverse
        best, total = min(self.cost), 0.0
        for cost in self.cost:
            total += exp(0.5 * (best - cost))
        return [exp(0.5 * (best - cost)) / total for cost in self.cost]


@pytest.mark.parametrize("hypotheses", [None, PAIR])
def test_a_diagnoser_in_python_has_the_digest_and_the_score_of_the_unit(hypotheses: Any) -> None:
    section = {"kind": "leaky_squares", **({"hypotheses": hypotheses} if hypotheses else {})}
    theirs = with_unit("leaky_squares", examples()[1], {**STORY, "diagnosers": {"mine": section}}, "ch5-seven-step")
    own = LeakySquares(theirs, hypotheses_of(theirs.spec.diagnosers["mine"].params))
    unit, outside = run(theirs), run(theirs, diagnosers={"mine": own})
    assert outside.digest == unit.digest and own.begun == 1
    assert 0.5 < unit.metrics["diagnosis.mine.correct_fraction"] < 1.0
    assert unit.metrics.pop("diagnosis.mine.nis") > 0.5 and outside.metrics == unit.metrics, "it says no residuals"


def test_one_that_the_scenario_does_not_have_stands_beside_its_own() -> None:
    scenario = with_values(get("ch5-seven-step"), {"samples": 400, "expect": []})
    plain = run(scenario)
    seen: list[Observation] = []

    def even(x: Observation) -> Any:
        seen.append(x)
        return np.full(6, 1.0 / 6.0)

    beside = run(scenario, diagnosers={"even": even})
    assert beside.signal("even.probability.b+30").tolist() == [1.0 / 6.0] * 400
    names = [name for name in plain.trace if not name.startswith("even.")]
    assert all(beside.signal(name).tobytes() == plain.signal(name).tobytes() for name in names)
    assert [x.measured for x in seen] == plain.signal("sensor.displacement").tolist()
    assert [x.applied for x in seen[1:]] == plain.signal("drive.voltage")[:-1].tolist()
    assert [x.tick for x in seen] == list(range(400)) and [x.begins for x in seen] == [True, *[False] * 399]


def test_an_identifier_in_python_has_the_digest_and_the_error_of_the_unit() -> None:
    values = {"identifiers.mine.kind": "fit", "events": STORY["events"], "samples": 900}
    theirs = with_unit("fit", FIT, values, "first-look")

    def fit(x: Observation) -> tuple[float, float, float]:
        return 1.0 + min(0.05, 0.001 * (x.tick + 1.0)), 1.0, 1.0

    unit, outside = run(theirs), run(theirs, identifiers={"mine": fit})
    assert outside.digest == unit.digest and outside.metrics == unit.metrics


def test_a_controller_and_diagnosers_from_outside_go_together_compiled_or_not() -> None:
    """The controller is the open loop; each diagnoser writes its inputs, so the trace shows the calls and their
    times."""

    def board(compiled: bool) -> Hosted:
        spec = parse(document({}, RICH))

        def law(x: Sample) -> float:
            return x.reference

        def kalman(x: Observation) -> list[float]:
            return [x.measured, x.applied, float(x.tick)]

        def slow(x: Observation) -> list[float]:
            return [x.dt_ms, float(x.tick)]

        return Hosted(spec, law, diagnosers={"slow": slow, "kalman": kalman}, compiled=compiled)

    fast, slow = board(compiled=True), board(compiled=False)
    trace = play(fast, 60)
    play(slow, 60)
    assert fast.digest() == slow.digest()
    alone = play(make(base=RICH), 60)
    assert trace["drive.voltage"].tobytes() == alone["drive.voltage"].tobytes()
    assert trace["kalman.probability.healthy"].tolist() == trace["sensor.displacement"].tolist()
    assert trace["kalman.probability.m+5"][1:].tolist() == trace["drive.voltage"][:-1].tolist()
    assert trace["slow.probability.m+5"].tolist() == [tick - tick % 2 for tick in range(60)], "it waits two samples"
    assert {*trace["slow.probability.healthy"]} == {0.02}


def test_it_begins_anew_after_a_reset() -> None:
    begun: list[int] = []

    def ask(x: Observation) -> list[float]:
        if x.begins:
            begun.append(x.tick)
        return [1.0, 0.0]

    board = Hosted(parse(document({}, RICH)), diagnosers={"slow": ask})
    play(board, 30)
    do(board, {"make_safe": "enough"})
    do(board, {"reset_trip": True})
    play(board, 10)
    assert begun == [0, 30]


def test_a_diagnoser_that_says_no_number_disturbs_nobody() -> None:
    result = run(with_values(get("ch5-seven-step"), {"samples": 50}), diagnosers={"odd": lambda _: [math.nan] * 6})
    assert result.trip is None and np.isnan(result.signal("odd.probability.healthy")).all()


@pytest.mark.parametrize("answer", [None, 0.5, [0.5] * 5, [0.5] * 7, "none", [[0.1] * 6], ["a"] * 6])
def test_another_answer_is_refused_in_one_line(answer: Any) -> None:
    line = r"^mine: must answer with 6 numbers, the probability of each hypothesis; at sample 0 it was "
    with pytest.raises(InputError, match=line):
        run(with_values(get("ch5-seven-step"), {"samples": 50}), diagnosers={"mine": lambda _: answer})


@pytest.mark.parametrize(
    ("key", "values", "field"),
    [
        ("diagnosers", {"device": {"id": "gyro-a"}}, "diagnosers.mine.kind"),
        ("identifiers", {"device": {"id": "gyro-a"}}, "identifiers.mine.kind"),
        ("diagnosers", {"device": {"id": "unstable-first-order"}}, "diagnosers.mine.kind"),
    ],
)
def test_a_bench_that_cannot_have_one_is_refused(key: str, values: dict[str, Any], field: str) -> None:
    asked: Any = {key: {"mine": lambda _: [1.0]}}
    with pytest.raises(InputError) as refused:
        Hosted(parse(values), **asked)
    assert refused.value.field == field


@pytest.mark.parametrize("key", ["diagnosers", "identifiers"])
def test_no_scenario_can_name_one(key: str) -> None:
    with pytest.raises(InputError, match=f"{key}.mine.kind: external is computed outside") as refused:
        make({key: {"mine": {"kind": "external"}}})
    assert refused.value.hint == f"combbench.run(..., {key}={{...}})"
    with pytest.raises(InputError):
        do(
            make({key: {"mine": {"kind": "mmae" if key == "diagnosers" else "gradient"}}}),
            {"set": {f"{key}.mine.kind": "external"}},
        )
