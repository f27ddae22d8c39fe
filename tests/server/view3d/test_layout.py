"""The shape: the drawing's numbers, and beams that bend as beams do."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from core.device.geometry import Geometry
from server.view3d.layout import UM_PER_UNIT, Layout, Skinned
from server.view3d.motion import WANTED_UM, caption, exaggeration, moment

LAYOUT = Layout(Geometry())


def bend(mesh: Skinned, bones: list[float]) -> NDArray[np.float64]:
    """Move the vertices as linear blend skinning does, bones shifted along x by um."""
    moved = mesh.vertices.copy() * UM_PER_UNIT
    moved[:, 0] += mesh.weights @ np.array(bones)
    return moved


def test_the_places_are_those_of_the_drawing() -> None:
    """The reference device: arms 95 to 106 um, fingers to 166, stators from 126, beams to 387.5."""
    assert LAYOUT.arm_um == pytest.approx(106.13, abs=0.01)
    assert LAYOUT.tip_um == pytest.approx(166.13, abs=0.01)
    assert LAYOUT.stator_um == pytest.approx(126.13, abs=0.01)
    assert LAYOUT.beam_to_um == 387.5
    assert LAYOUT.pitch_um == pytest.approx(8.0)
    places, _ = LAYOUT.fingers()
    assert len(places) == 2 * 87 and len(LAYOUT.stators()[0]) == 2 * 88
    assert np.abs(places[:, 1]).max() * UM_PER_UNIT == pytest.approx(344.0)


def test_moving_fingers_stand_between_fixed_ones() -> None:
    moving, fixed = LAYOUT.fingers()[0], LAYOUT.stators()[0]
    gaps = np.abs(moving[:87, 1][:, None] - fixed[:88, 1][None, :]).min(1) * UM_PER_UNIT
    np.testing.assert_allclose(gaps, LAYOUT.pitch_um / 2)


def test_weights_are_shares_of_four_bones() -> None:
    mesh = LAYOUT.suspension()
    assert mesh.weights.shape == (len(mesh.vertices), 4)
    np.testing.assert_allclose(mesh.weights.sum(1), 1.0)
    assert mesh.faces.max() < len(mesh.vertices)


def test_beams_bend_as_guided_beams() -> None:
    """Shuttle shifted by v, trusses by v/2: u = (v/2)(3s^2 - 2s^3) from the anchor, flat at both ends."""
    v, mesh = 10.0, LAYOUT.suspension()
    moved = bend(mesh, [0.0, v, v / 2, v / 2])
    rest = mesh.vertices * UM_PER_UNIT
    shift = moved[:, 0] - rest[:, 0]
    y = np.abs(rest[:, 1])
    s = np.clip((y - 37.5) / 350.0, 0.0, 1.0)
    curve = v / 2 * (3 * s**2 - 2 * s**3)
    inner = np.abs(np.abs(rest[:, 0]) - 15) < 1
    outer = np.abs(np.abs(rest[:, 0]) - 45) < 1
    beams = y <= 387.5
    np.testing.assert_allclose(shift[inner & beams], curve[inner & beams], atol=1e-9)
    np.testing.assert_allclose(shift[outer & beams], v - curve[outer & beams], atol=1e-9)
    np.testing.assert_allclose(shift[y > 388], v / 2)


def test_slow_motion_is_true_and_fast_motion_is_strobed() -> None:
    slow = moment(1000, 50.0, 200.0, 0.0)  # 4 periods a second
    assert (slow.tick, slow.is_strobed) == (999, False)
    assert not moment(1000, None, 1e5, 0.0).is_strobed
    ticks = [moment(100_000 + 1667 * n, 50.0, 1e5, n / 60) for n in range(120)]
    assert all(one.is_strobed for one in ticks)
    for n, one in enumerate(ticks):
        assert 0 <= 100_000 + 1667 * n - 1 - one.tick <= 50
    # The phase shown runs slowly and evenly: 0.8 turns a second.
    phase = np.unwrap([2 * np.pi * one.tick / 50.0 for one in ticks]) / (2 * np.pi)
    assert phase[60] - phase[0] == pytest.approx(0.8, abs=0.05)


def test_motion_is_magnified_by_a_round_factor_that_keeps() -> None:
    assert exaggeration(0.05, 1.0) == 100.0
    assert exaggeration(4.0, 1.0) == 4.0
    assert exaggeration(100.0, 5.0) == 1.0
    assert exaggeration(0.0, 7.0) == 7.0
    factor = exaggeration(4.0, 1.0)
    for amplitude in (3.0, 4.5, 2.0):
        assert exaggeration(amplitude, factor) == factor
    assert 4.0 * factor <= WANTED_UM
    assert caption(1.0, False) == "true scale"
    assert caption(5.0, True) == "motion × 5, strobe"
