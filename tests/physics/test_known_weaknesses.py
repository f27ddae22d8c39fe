"""What blocks say of their weaknesses is measured: the figures of each sentence, against an oracle of its own."""

from __future__ import annotations

import math

import numpy as np
import pytest

from core import registry
from core.device.catalogue import device
from core.plant.planar import Planar
from core.plant.suspension import elastic_force
from core.sense.single_beam import SingleBeam
from scenarios.measure.sensing import good_squares, whole_periods
from tests.core.sense.bench import errors
from tests.lab import do, play, rms
from tests.physics.large_displacement import Frame
from tests.physics.plane import KT, XR, bench

LCR = device({"id": "lcr-350"}).drawing


def test_only_sentences_are_said():
    said = [text for family in registry.FAMILIES for card in registry.catalog(family) for text in card.weaknesses]
    assert said and all(text.endswith(".") and text[0].isupper() for text in said)


# -- planar


def ours(fault: str, parameters: dict[str, str], travel: float) -> tuple[float, float, float]:
    """Force along x at a travel and where the planar plant rests across it."""
    board = bench(0.0)
    do(board, {"fault": fault, "severity": 1.0, "parameters": parameters})
    board.advance(2)
    k = board.wiring.state("plant").suspension
    shift, turn = k.sideways * travel * travel, (k.turn + k.turn_cubic * travel * travel) * travel
    along, across, torque = elastic_force(k, travel, shift, turn)
    assert (across, torque) == pytest.approx((0.0, 0.0), abs=1e-15)
    return -along, shift, turn


def corner(shift: float, turn: float) -> float:
    """Sideways displacement of the worst corner, um."""
    return max(abs(shift + turn * XR), abs(shift - turn * XR))


END = ("broken_truss", {"extent": "end"}, Frame(LCR, lost=(2,)))
WHOLE = ("broken_truss", {"extent": "whole"}, Frame(LCR, lost=(0, 1, 2)))
STUCK = ("point_adhesion", {}, Frame(LCR, adhesion=0.75))


@pytest.mark.parametrize(
    ("damage", "travel", "shifts_nm", "corners_nm"),
    [(END, 1.0, (0.1, -0.6), (2.1, 3.1)), (END, 8.0, None, (24.0, 49.0)), (STUCK, 1.0, (1.1, 0.6), None)],
    ids=["truss end", "truss end, far", "adhesion"],
)
def test_across_the_drive_the_planar_plant_is_rough_where_it_says_so(damage, travel, shifts_nm, corners_nm):
    fault, parameters, frame = damage
    (_, shift, turn), (_, true_shift, true_turn) = ours(fault, parameters, travel), frame.follow(travel)
    if shifts_nm:
        assert (1e3 * shift, 1e3 * true_shift) == pytest.approx(shifts_nm, abs=0.05)
    if corners_nm:
        found = 1e3 * corner(shift, turn), 1e3 * corner(true_shift, true_turn)
        assert found == pytest.approx(corners_nm, rel=0.03)


@pytest.mark.parametrize("damage", [END, WHOLE, STUCK], ids=["truss end", "whole truss", "adhesion"])
@pytest.mark.parametrize("travel", [-1.0, 0.1, 1.0])
def test_along_x_it_is_right_at_small_strokes(damage, travel):
    fault, parameters, frame = damage
    assert ours(fault, parameters, travel)[0] == pytest.approx(frame.follow(travel)[0], rel=5e-3)


@pytest.mark.parametrize("travel", [-2.0, 0.5, 4.0])
def test_with_a_whole_truss_lost_it_is_right_across_too(travel):
    fault, parameters, frame = WHOLE
    assert corner(*ours(fault, parameters, travel)[1:]) == pytest.approx(corner(*frame.follow(travel)[1:]), rel=5e-3)


@pytest.mark.parametrize(("step_us", "share"), [(0.25, 1.0), (0.5, 0.94), (1.0, 0.46)])
def test_long_substeps_lose_brownian_motion_sideways(step_us, share):
    board = bench(0.0, thermal_noise=True, step_us=step_us, near_step_us=min(step_us, 0.25))
    shift = play(board, 60_000)["plant.shift"][1000:]
    assert rms(shift) == pytest.approx(share * math.sqrt(KT / 205.4) * 1e6, rel=0.03)
    assert f"{share:g}" in Planar.weaknesses[1] or share == 1.0


# -- single beam


def lost(hertz: float, positions: int, stiffness: float = 0.0, **unit: float) -> float:
    """Mean share of samples lost at a stroke of 4 um."""
    x = hertz / 2483.78
    volts = 4.0 / 0.5454 * abs(1 - x * x + 1j * x / 4.8623)
    values = {
        "sensor": {"kind": "single_beam", **unit},
        "reference.frequency_hz": hertz,
        "reference.amplitude_v": volts,
    }
    found = errors(values, range(1, positions + 1), stiffness=stiffness)
    good = [good_squares(row, np.zeros(len(row)), 4.0, whole_periods([row], 4.0)) for row in found]
    return 1.0 - float(np.mean([len(squares) / len(row) for squares, row in zip(good, found, strict=True)]))


def test_one_beam_loses_slow_motion_and_says_what_helps():
    assert "23 % of the samples at 159 Hz" in SingleBeam.weaknesses[0]
    assert lost(159.155, 40) == pytest.approx(0.23, abs=0.05)
    assert lost(1000.0, 10) == 0.0
    for stiffness in (0.0, 0.1):
        assert lost(159.155, 10, stiffness, force_rate_per_ms=0.4) == 0.0
