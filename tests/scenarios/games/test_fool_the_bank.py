"""Fool the bank: the edge against a scan of severities with whole runs, and the points by the rule."""

from __future__ import annotations

import pytest

from core.errors import InputError
from scenarios.games import game_of
from scenarios.games.draw import Draws
from scenarios.games.edge import Edge, document
from scenarios.games.fool_the_bank import Named, points
from scenarios.run import run
from scenarios.schema import Scenario

GAME = game_of("fool-the-bank")


def missed_in(seed: int, fault: str, severity: float) -> int:
    """Count the runs that miss a fault, each from its first sample on."""
    missed = 0
    event = {"at_sample": 1500, "fault": fault, "severity": severity}
    scenario = Scenario.load({**document(seed), "samples": 4000, "events": [event]})
    noises = Draws("fool-the-bank", seed).noise_seeds(10)
    assert len(set(noises)) == 10
    for noise in noises:
        winner = run(scenario, noise).trace["kalman.winner"]
        assert len(winner) == 4000
        missed += int((winner[3500:] == 0.0).sum()) > 250
    return missed


def a_fault(seed: int) -> str:
    """Return the first fault that a seed offers."""
    return GAME.kinds(seed)[0].name


def is_first_found(seed: int, fault: str, end: float, steps: int) -> bool:
    """Whether the edge is the first that a scan finds, in so many steps from half the edge to the edge."""
    edge = Edge(seed, fault, end).find()
    assert edge is not None and edge * end > 0.0
    scan = [edge * (0.5 + 0.5 * step / steps) for step in range(steps + 1)]
    found = next(severity for severity in scan if missed_in(seed, fault, severity) < 9)
    just_below = edge / 2 ** (1.0 / 512.0) * (1.0 - 1e-12)  # the last step before it was missed
    return abs(found) >= 0.97 * abs(edge) and missed_in(seed, fault, edge) < 9 <= missed_in(seed, fault, just_below)


def test_the_edge_is_the_first_that_a_scan_finds():
    assert is_first_found(2, "damping", -0.6, 8)


@pytest.mark.long
@pytest.mark.parametrize(
    ("seed", "fault", "end"), [(1, "stiffness", 1.0), (2, "damping", -0.6), (3, "sensor_hum", 5.0)]
)
def test_the_edge_is_the_first_that_a_fine_scan_finds(seed, fault, end):
    assert is_first_found(seed, fault, end, 25)


def test_points_follow_the_rule():
    kind = GAME.kinds(5)[0]
    end = kind.maximum
    edge = Edge(5, kind.name, end).find()
    assert edge is not None
    near = GAME.judge(5, Named(fault=kind.name, severity=0.9 * edge))
    assert missed_in(5, kind.name, 0.9 * edge) == near.figures["missed_in"] >= 9
    assert near.points == pytest.approx(90.0) and near.figures["edge"] == edge
    above = GAME.judge(5, Named(fault=kind.name, severity=min(1.3 * edge, end)))
    assert above.figures["missed_in"] < 9 and above.points == 0.0 and "finds" in above.said
    assert GAME.judge(5, Named(fault=kind.name, severity=0.9 * edge)) == near


def test_a_fault_without_an_edge_earns_nothing_and_says_so(monkeypatch):
    monkeypatch.setattr(Edge, "missed_in", lambda *_: 10)
    outcome = GAME.judge(5, Named(fault="damping", severity=0.5))
    assert outcome.points == 0.0 and "edge" not in outcome.figures
    assert "finds this fault nowhere up to damping of 200.00\N{NO-BREAK SPACE}%" in outcome.said


def test_what_is_missed_again_beyond_the_edge_counts_from_the_first_edge(monkeypatch):
    monkeypatch.setattr(Edge, "missed_in", lambda _, severity: 0 if 0.1 <= severity < 0.3 else 10)
    outcome = GAME.judge(5, Named(fault="damping", severity=0.4))
    edge = outcome.figures["edge"]
    assert edge == pytest.approx(0.1, rel=2e-3) and edge >= 0.1
    assert outcome.points == pytest.approx(100.0 * edge / 0.4)
    assert "beyond the edge, and the bank misses it again" in outcome.said


def test_points_are_100_at_the_edge_and_fall_on_both_sides():
    assert points(0.2, 9, 0.2) == 100.0
    assert points(0.1, 10, 0.2) == points(0.4, 10, 0.2) == 50.0
    assert points(0.1, 8, 0.2) == 0.0 and points(0.1, 10, None) == 0.0


def test_a_seed_offers_three_faults_of_which_one_is_of_the_device():
    for seed in range(30):
        names = [kind.name for kind in GAME.kinds(seed)]
        assert len(set(names)) == 3 and sum(not name.startswith("sensor_") for name in names) == 1
    assert len({GAME.kinds(seed)[0].name for seed in range(30)}) == 4


def test_a_wrong_name_or_severity_is_refused():
    kinds = {kind.name for kind in GAME.kinds(1)}
    other = next(iter({"added_mass", "stiffness", "damping", "drive_gain"} - kinds))
    with pytest.raises(InputError, match="fault: unknown fault"):
        GAME.read(1, {"fault": other, "severity": 0.1})
    name = GAME.kinds(1)[0].name
    with pytest.raises(InputError, match="severity: must be from"):
        GAME.read(1, {"fault": name, "severity": 4.0})
    with pytest.raises(InputError, match="and not 0"):
        GAME.read(1, {"fault": name, "severity": 0.0})
