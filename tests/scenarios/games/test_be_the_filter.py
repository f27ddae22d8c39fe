"""Be the filter: the points against a computation from the raw probabilities, and whom the rule rewards."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from core.errors import InputError
from scenarios.games import game_of
from scenarios.games.be_the_filter import FilterAssumptions, document
from scenarios.games.states import DATA_SHEET_UM, GIVEN, HiddenState
from scenarios.run import run
from scenarios.schema import Scenario

GAME = game_of("be-the-filter")
SEEDS = range(4)


def true_settings(hidden: HiddenState, **other: float) -> FilterAssumptions:
    """Return the settings of one who knows everything: Q and R as they are, and the unknown fault."""
    scale = (hidden.noise_um / DATA_SHEET_UM) ** 2
    factors = hidden.unknown.model_dump(include={"mass", "stiffness", "damping"})
    known = {"assumed_noise_scale": scale, "process_noise_v": hidden.drive_noise_v / math.sqrt(scale)}
    return FilterAssumptions(**{**known, **factors, **other})


def motion(hidden: HiddenState, mass: float = 1.0, stiffness: float = 1.0, damping: float = 1.0) -> complex:
    """Return the phasor of the motion at 2 kHz by its formula, um."""
    nominal = hidden.bench.spec.device.resolved
    w = 2.0 * math.pi * 2000.0
    force = hidden.bench.spec.device.oscillator().force * 10.0  # uN
    compliance = 1.0 / complex(
        nominal["stiffness_n_m"] * stiffness - nominal["mass_kg"] * mass * w * w, nominal["damping_ns_m"] * damping * w
    )
    return force * compliance  # uN over N/m is um


@pytest.mark.parametrize("seed", [3, pytest.param(0, marks=pytest.mark.long)])
def test_points_are_those_of_the_raw_probabilities(seed):
    hidden = HiddenState(seed)
    # most of the way to the unknown fault on each factor
    part = {name: getattr(hidden.unknown, name) ** 0.7 for name in ("mass", "stiffness", "damping")}
    settings = true_settings(hidden, **part)
    outcome = GAME.judge(seed, settings)
    away = abs(motion(hidden, **part) - motion(hidden, **hidden.unknown.model_dump(include=set(part))))
    nearest = min(
        abs(
            motion(hidden, one.mass, one.stiffness, one.damping)
            - motion(hidden, **hidden.unknown.model_dump(include=set(part)))
        )
        for one in GIVEN
    )
    weight = 1.0 - away / nearest
    gaps = [abs(motion(hidden, **part) - motion(hidden, one.mass, one.stiffness, one.damping)) for one in GIVEN]
    like = gaps.index(min(gaps))
    assert 0.1 < weight < 0.9 and outcome.figures["credit"] == pytest.approx(weight, rel=1e-9)

    bounds = [0, *(1500 + 1000 * n for n in range(7))]
    scenario = Scenario.load({**document(hidden, settings), "samples": 7500})
    total = 0.0
    noises = hidden.draws.noise_seeds(5)
    assert len(set(noises)) == 5
    for noise in noises:
        trace = run(scenario, noise, figures_only=True).trace
        for state, (start, end) in zip(hidden.states, pairwise(bounds), strict=True):
            for i in range(start, end):
                p = [trace[f"kalman.probability.{name}"][i] for name in ("healthy", "m+5", "m+10", "k+5", "b+30")]
                six = trace["kalman.probability.sixth"][i]
                said = [*p, weight * six]
                said[like] += (1.0 - weight) * six
                total += sum((q - (1.0 if place == state else 0.0)) ** 2 for place, q in enumerate(said))
    assert outcome.points == pytest.approx(100.0 * (1.0 - total / (5 * 7500) / (5.0 / 6.0)), rel=1e-9)


def test_the_parts_make_up_the_whole():
    hidden = HiddenState(1)
    figures = GAME.judge(1, FilterAssumptions(mass=1.2)).figures
    unknown = hidden.states.count(5) * 1000 / 7500
    assert unknown == pytest.approx(2000 / 7500)
    whole = (1 - unknown) * figures["brier_given"] + unknown * figures["brier_unknown"]
    assert figures["brier"] == pytest.approx(whole, rel=1e-12)


def test_who_tells_the_truth_earns_more_than_who_is_too_sure_and_who_is_not_sure_enough():
    truth, sure, unsure = [], [], []
    for seed in SEEDS:
        hidden = HiddenState(seed)
        scale = true_settings(hidden).assumed_noise_scale
        for earned, factor in ((truth, 1.0), (sure, 0.25), (unsure, 4.0)):
            earned.append(GAME.judge(seed, true_settings(hidden, assumed_noise_scale=scale * factor)).points)
    assert all(t > max(s, u) for t, s, u in zip(truth, sure, unsure, strict=True)), (truth, sure, unsure)
    assert np.mean(truth) > np.mean(sure) + 10.0
    assert np.mean(truth) > np.mean(unsure) + 1.0


@pytest.mark.parametrize("seed", [0, pytest.param(3, marks=pytest.mark.long)])
def test_a_sixth_hypothesis_pays_only_near_the_unknown_fault(seed):
    hidden = HiddenState(seed)
    none = GAME.judge(seed, true_settings(hidden, mass=1.0, stiffness=1.0, damping=1.0))
    assert none.figures["credit"] == 0.0
    assert GAME.judge(seed, true_settings(hidden)).points > none.points + 40.0
    for one in GIVEN:  # a copy, as near as a double can be without being one
        copy = {name: value * (1.0 + 1e-9) for name, value in one.model_dump(exclude={"name", "gain"}).items()}
        outcome = GAME.judge(seed, true_settings(hidden, **copy))
        assert outcome.figures["credit"] < 1e-6
        assert outcome.points < none.points + 3.0  # twice one model is twice its odds, and no more


def test_what_is_drawn_is_within_what_is_said_of_it():
    for seed in range(40):
        hidden = HiddenState(seed)
        assert not 0.75 < hidden.noise_um / DATA_SHEET_UM < 4.0 / 3.0
        assert hidden.states[0] == 0 and len(hidden.states) == 7 and hidden.states.count(5) == 2
        assert hidden.states.count(0) == 2 and len({*hidden.states}) == 5
        assert all(a != b for a, b in pairwise(hidden.states))
        unknown = motion(hidden, **hidden.unknown.model_dump(include={"mass", "stiffness", "damping"}))
        apart = min(abs(motion(hidden, one.mass, one.stiffness, one.damping) - unknown) for one in GIVEN)
        assert 0.12 - 1e-9 < apart / abs(motion(hidden)) < 0.8 + 1e-9
    assert HiddenState(1).device != HiddenState(2).device
    assert [fact.said for fact in GAME.hidden(1)] == [fact.said for fact in GAME.hidden(1)]


def test_the_live_bench_has_other_noise_and_the_same_faults():
    bench = GAME.bench(3, FilterAssumptions(process_noise_v=0.7))
    hidden = HiddenState(3)
    assert bench["seed"] not in hidden.draws.noise_seeds(5)
    assert bench["diagnosers"]["kalman"]["process_noise_v"] == 0.7
    Scenario.load(bench)
    assert bench["events"] == hidden.events


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ({"probability_floor": 0.2}, "probability_floor: must be <= 0.05, got 0.2"),
        ({"noise": 1.0}, "noise: unknown field"),
        ({"mass": float("nan")}, "mass: must be a finite number"),
        ({"damping": "much"}, "damping: must be a number"),
    ],
)
def test_a_wrong_hand_in_is_refused_by_its_field(values, text):
    with pytest.raises(InputError, match=text.split(",")[0]):
        GAME.read(1, values)
