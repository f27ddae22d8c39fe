"""The schematic gyroscope: parts keep together while the mass moves, and none meets another."""

from __future__ import annotations

import numpy as np
import pytest

from server.view3d.flexure import RINGS, beam
from server.view3d.gyroscope import parts
from server.view3d.gyroscope.gyroscope import FRONT, turning
from server.view3d.gyroscope.orbit import WANTED_UM, caption, full_scale, magnified, met
from server.view3d.gyroscope.parts import (
    ANCHOR_UM,
    AXES,
    BAR_UM,
    BASE_UM,
    MASS_UM,
    RETURN_UM,
    STATOR_UM,
    TIP_UM,
    Ground,
)
from server.view3d.page import cameras
from server.view3d.part import units

PAIR = ("x", "y", "partner_x", "partner_y")
REACH_UM = 1.2 * WANTED_UM
"""Farthest the magnified motion goes before another factor is chosen."""


def test_a_beam_is_the_cubic_between_its_ends() -> None:
    """Guided at both ends, u(s) = u0 + (u1 - u0)(3 s^2 - 2 s^3)."""
    ends = np.array([[[1.0, 0.0], [0.0, 1.0]], [[0.5, 0.0], [0.0, 0.0]]])
    part = beam((0.0, 0.0), (0.0, 60.0), 4.0, 10.0, 20.0, ends)
    moved = (part.follow @ (8.0, 3.0, 0.0)).reshape(RINGS, 4, 2)
    s = np.linspace(0.0, 1.0, RINGS)
    rise = 3 * s**2 - 2 * s**3
    for corner in range(4):
        np.testing.assert_allclose(moved[:, corner], np.column_stack([8.0 - 4.0 * rise, 3.0 - 3.0 * rise]))
    assert np.ptp(part.rest, axis=0).tolist() == [4.0, 60.0, 10.0]


@pytest.mark.parametrize(("axis", "a"), [("x", 0), ("y", 1)])
def test_beams_stay_on_what_they_join(axis: str, a: int) -> None:
    """On the mass they move as it does, on a bar as the bar, at an anchor not at all."""
    part = parts.flexures(axis)
    moved = part.follow @ (11.0, 7.0, 0.0)
    along, across = part.rest[:, a], part.rest[:, 1 - a]
    whole, alone = np.array((11.0, 7.0)), np.where(np.arange(2) == a, (11.0, 7.0), 0.0)
    at_anchor = (np.abs(np.abs(along) - RETURN_UM) < 3.0) & (np.abs(np.abs(across) - ANCHOR_UM) < 9.5)
    at_bar = (np.abs(np.abs(along) - BAR_UM) < 3.0) & (np.abs(np.abs(across) - parts.BAR_LENGTH_UM) < 0.1)
    at_mass = np.abs(np.abs(across) - MASS_UM) < 0.1
    at_other = np.abs(np.abs(across) - (BAR_UM - 6.0)) < 0.1
    for chosen, wanted in ((at_anchor, 0.0 * whole), (at_bar, alone), (at_mass, whole), (at_other, whole - alone)):
        assert chosen.sum() == 16
        np.testing.assert_allclose(moved[chosen], np.broadcast_to(wanted, (16, 2)), atol=1e-12)


def test_nothing_collides_at_the_largest_motion() -> None:
    assert MASS_UM + REACH_UM < BAR_UM - parts.BAR_WIDTH_UM / 2
    assert BAR_UM + parts.BAR_WIDTH_UM / 2 + REACH_UM < min(STATOR_UM, RETURN_UM - 10.0)
    assert TIP_UM + REACH_UM < BASE_UM - 9.0
    for axis, a in (("x", 0), ("y", 1)):
        moving = parts.bars()
        carried = np.abs(moving.follow[:, a, a]) > 0.0
        fingers = carried & (np.abs(moving.rest[:, a]) > TIP_UM - 1.0)
        fixed = parts.stators(axis).vertices
        tips = fixed[np.abs(fixed[:, a]) < STATOR_UM + 1.0]
        gaps = np.abs(moving.rest[fingers][:, None, 1 - a] - tips[None, :, 1 - a])
        assert fingers.sum() == 56 and len(tips) == 64
        assert gaps.min() == pytest.approx(parts.PITCH_UM / 2 - parts.FINGER_UM)


def test_bars_move_along_their_axis_alone() -> None:
    part = parts.bars()
    moved = part.follow @ (3.0, 5.0, 0.0)
    far = part.rest[np.abs(part.rest[:, 0]) > STATOR_UM], moved[np.abs(part.rest[:, 0]) > STATOR_UM]
    assert len(far[0]) > 0 and (far[1] == (3.0, 0.0)).all()
    assert set(map(tuple, moved.tolist())) == {(3.0, 0.0), (0.0, 5.0)}


@pytest.mark.parametrize("period", [25.476, 38.1, 333.3])
def test_a_strobe_meets_the_phase_whatever_the_period(period: float) -> None:
    t = np.arange(round(3.2 * period))
    for start in (0.1, 2.7):
        motion = 5.0 * np.sin(2 * np.pi * t / period + start)
        for phase in (0.0, 0.25, 0.6, 0.99):
            found = met(motion, phase)
            assert found is not None
            turns = (found / period + start / (2 * np.pi) - phase + 0.5) % 1.0 - 0.5
            assert abs(turns) <= 0.51 / period + 1e-3
    assert met(np.zeros(80), 0.5) is None and met(np.ones(80), 0.5) is None


def test_each_axis_has_a_round_factor_unless_the_orbit_is_wide() -> None:
    """5 um and 258.6 pm per deg/s: 25.0 and 25.9 um; a circle stays a circle."""
    x, y = magnified((5.0, 258.6e-6), (1.0, 1.0))
    assert (x, y) == (5.0, 1e5)
    assert magnified((4.0, 200e-6), (x, y)) == (x, y)
    assert magnified((5.0, 4.0), (x, y)) == (5.0, 5.0)
    assert magnified((1.2, 5.0), (x, y)) == (5.0, 5.0)
    assert magnified((5.0, 0.0), (x, y)) == (x, y)
    assert magnified((1e-9, 0.0), (1.0, 1.0))[0] == 1e6
    for size in np.geomspace(1e-4, 30.0, 200):
        assert (
            0.39 * WANTED_UM < size * magnified((size, 0.0), (1.0, 1.0))[0] <= WANTED_UM * (1.0 + 1e-9) or size > 12.8
        )


def test_half_the_ring_is_a_round_rate_with_room_above() -> None:
    assert full_scale(100.0, 100.0) == 200.0
    assert full_scale(0.0, 200.0) == 200.0 and full_scale(60.0, 200.0) == 200.0
    for largest in np.geomspace(1e-3, 1e5, 300):
        scale = full_scale(float(largest), 1e9)
        assert 0.3 < largest / scale <= 0.8
        digit, _, rest = f"{scale:.6e}".partition(".")
        assert digit in "125" and rest.startswith("000000")


@pytest.mark.parametrize(("share", "angle"), [(0.5, 0.0), (-0.25, -0.75 * np.pi), (1.0, 0.5 * np.pi)])
def test_the_arc_goes_the_way_the_frame_turns(share: float, angle: float) -> None:
    """Counter-clockwise from the front for a positive rate, half the ring for the whole scale."""
    vertices = turning(share).vertices
    start, tip = vertices[0], vertices[-5]
    assert np.arctan2(start[1], start[0]) == pytest.approx(FRONT)
    assert np.arctan2(tip[1], tip[0]) == pytest.approx(angle + np.copysign(0.11, share))
    assert len(turning(0.0).faces) == len(turning(share).faces)


def test_what_is_not_as_in_nature_is_said() -> None:
    said = "schematic, not to scale, motion x × 5, y × 100\u202f000, half ring 200 deg/s, strobe"
    assert caption((5.0, 1e5), 200.0, True).replace("\u00a0", " ") == said
    assert "strobe" not in caption((5.0, 1e5), 200.0, False)


@pytest.mark.parametrize("axes", [PAIR[:2], PAIR])
def test_every_camera_of_the_page_looks_at_the_device(axes: tuple[str, ...]) -> None:
    layout = Ground(axes)
    ground = units(layout.mesh().vertices)
    low, high = ground.min(0), ground.max(0)
    views = cameras(layout.views())
    assert list(views) == ["whole", "top", "side", "fingers", "beams"]
    for name, view in views.items():
        box = np.array(view["box"])
        assert (box[:, 0] < box[:, 1]).all()
        if name in ("fingers", "beams"):
            assert (box[:2, 0] >= low[:2]).all() and (box[:2, 1] <= high[:2]).all()
        else:
            assert (box[:2, 0] <= low[:2]).all() and (box[:2, 1] >= high[:2]).all()
    assert len(layout.centres) == len(axes) // 2 and set(AXES) == set(axes[:2])
