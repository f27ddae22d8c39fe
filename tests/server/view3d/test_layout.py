"""The shape and its motion: the drawing's numbers, the magnified and printed quantities, the warnings."""

from __future__ import annotations

import numpy as np
import pytest

from core.device.geometry import Geometry
from core.plant.linear import Linear
from core.plant.planar import Planar
from server.view3d.colours import ATTENTION, MOVING, blend, in_batch
from server.view3d.motion import (
    TURN_EXAGGERATIONS,
    WANTED_TURN_UM,
    WANTED_UM,
    caption,
    exaggeration,
    moment,
    warning,
)
from server.view3d.page import cameras
from server.view3d.part import UM_PER_UNIT
from server.view3d.resonator.layout import Layout
from server.view3d.resonator.resonator import combs_of
from server.view3d.resonator.suspension import flexure

LAYOUT = Layout(Geometry())


def test_the_places_are_those_of_the_drawing() -> None:
    """The reference device: arms 95 to 106 um, fingers to 166, stators from 126, beams to 387.5."""
    assert LAYOUT.arm_um == pytest.approx(106.13, abs=0.01)
    assert LAYOUT.tip_um == pytest.approx(166.13, abs=0.01)
    assert LAYOUT.stator_um == pytest.approx(126.13, abs=0.01)
    assert LAYOUT.beam_to_um == 387.5
    assert LAYOUT.pitch_um == pytest.approx(8.0)
    places = LAYOUT.fingers(1.0)
    assert len(places) == 87 and len(LAYOUT.stators(1.0)) == 88
    assert np.abs(places[:, 1]).max() == pytest.approx(344.0)


def test_moving_fingers_stand_between_fixed_ones() -> None:
    moving, fixed = LAYOUT.fingers(-1.0), LAYOUT.stators(-1.0)
    gaps = np.abs(moving[:, 1][:, None] - fixed[:, 1][None, :]).min(1)
    np.testing.assert_allclose(gaps, LAYOUT.pitch_um / 2)
    assert (moving[:, 0] < 0).all() and (fixed[:, 0] < 0).all()


def test_slow_motion_is_true_and_fast_motion_is_strobed() -> None:
    assert moment(1000, 50.0, 200.0, 0.0) == (999, False)  # 4 periods a second
    assert moment(1000, None, 1e5, 0.0) == (999, False)
    ticks = [moment(100_000 + 1667 * n, 50.0, 1e5, n / 60) for n in range(120)]
    for n, (tick, is_strobed) in enumerate(ticks):
        assert is_strobed and 0 <= 100_000 + 1667 * n - 1 - tick <= 50
    # The phase shown runs slowly and evenly: 0.8 turns a second.
    phase = np.unwrap([2 * np.pi * tick / 50.0 for tick, _ in ticks]) / (2 * np.pi)
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


def test_a_rotation_is_magnified_to_what_the_ends_of_the_arms_can_show() -> None:
    """An adhesion turns LCR-350 by 32 rad per m of travel: 2.7 um give 86 urad, 30 nm at the end of an arm."""
    ends_um = 32e-6 * 2.7 * 345.0
    factor = exaggeration(ends_um, 1.0, WANTED_TURN_UM, TURN_EXAGGERATIONS)
    assert factor == 200.0
    assert exaggeration(2 * ends_um, factor, WANTED_TURN_UM, TURN_EXAGGERATIONS) == factor
    assert exaggeration(40.0, factor, WANTED_TURN_UM, TURN_EXAGGERATIONS) == 1.0
    assert exaggeration(1e-6, factor, WANTED_TURN_UM, TURN_EXAGGERATIONS) == 2000.0


def test_what_is_not_as_in_nature_is_said() -> None:
    said = caption(5.0, 200.0, True)
    for part in ("motion × 5", "rotation × 200", "gaps × 1", "heights × 4", "beam widths × 2.5", "strobe"):
        assert part.replace("× ", "×\u00a0") in said
    assert "rotation" not in caption(1.0, None, False) and "strobe" not in caption(1.0, None, False)
    beams = flexure(LAYOUT, 1).rest
    assert np.ptp(beams[:4, 0]) == pytest.approx(2.5 * LAYOUT.geometry.beam_um)
    assert np.ptp(beams[:4, 2]) == pytest.approx(4.0 * LAYOUT.geometry.thickness_um)


def test_a_comb_warns_before_stability_is_lost() -> None:
    """A tenth of the gap, where the earliest fold is, already takes a third of the colour; contact takes it all."""
    assert warning(0.0, 2.1) == 0.0 and warning(2.1, 2.1) == warning(3.0, 2.1) == 1.0
    assert warning(-0.21, 2.1) == pytest.approx(0.1**0.5) and warning(0.21, 2.1) > 0.3
    assert blend(MOVING, ATTENTION, 0.0) == MOVING and blend(MOVING, ATTENTION, 1.0) == ATTENTION


def test_fingers_are_off_centre_by_shift_and_rotation() -> None:
    """y + theta X at +x, y - theta X at -x, with the offset of fabrication."""
    plant = Planar.Params(misalignment_um=0.1, misalignment_mrad=1.0)
    right, left = combs_of(0.2, 2e-3, 166.0, plant)
    assert right == pytest.approx(0.3 + 3e-3 * 166.0) and left == pytest.approx(0.3 - 3e-3 * 166.0)
    assert combs_of(0.2, 0.0, 166.0, Linear.Params()) == (0.2, 0.2)


def test_colours_of_a_batch_are_linear() -> None:
    """IEC 61966-2-1: black and white stay, the middle grey 188 is half the light."""
    assert in_batch((0, 255, 188)).tolist() == [0, 255, 128]


@pytest.mark.parametrize("name", ["whole", "top", "side", "fingers", "beams"])
def test_cameras_look_at_the_device(name: str) -> None:
    view = cameras(LAYOUT.views())[name]
    low, high = (UM_PER_UNIT * np.array(end) for end in zip(*view["box"], strict=True))
    assert (low <= high).all() and (high[:2] <= (LAYOUT.half_length_um, LAYOUT.half_width_um)).all()
    if name in ("whole", "top", "side"):
        np.testing.assert_allclose(high[:2], (LAYOUT.half_length_um, LAYOUT.half_width_um))
