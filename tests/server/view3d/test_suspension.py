"""Beams in their true shape: the cubics of beam theory, the stiffness of the drawing, and what damage changes."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from core.device.frame import Damage, stiffness
from core.device.geometry import Geometry
from server.view3d.flexure import Flexure
from server.view3d.resonator.layout import Layout
from server.view3d.resonator.suspension import BEAM_RINGS, TRUSS_RINGS, flexure

LAYOUT = Layout(Geometry())
STIFF = Layout(Geometry(truss_width_um=60.0))
"""With trusses that do not bend."""
OUTER, INNER = (-45.0, 45.0), (-15.0, 15.0)


def beam(part: Flexure, x: float) -> NDArray[np.bool_]:
    """Say which vertices belong to the beam at ``x``: a beam has as many rings in a row."""
    found = np.zeros(len(part.rest), bool)
    for first in range(0, 4 * BEAM_RINGS * 4, 4 * BEAM_RINGS):
        rows = slice(first, first + 4 * BEAM_RINGS)
        found[rows] = abs(part.rest[rows, 0].mean() - x) < 1.0
    return found


def centre(values: NDArray[np.float64], rows: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Return one value per ring."""
    return values[rows].reshape(-1, 4, *values.shape[1:]).mean(1)


@pytest.mark.parametrize("side", [1, -1])
def test_beams_between_stiff_trusses_bend_as_guided_beams(side: int) -> None:
    """Shuttle shifted by v, trusses by v/2: u = (v/2)(3s^2 - 2s^3) from the anchor, flat at both ends."""
    v, part = 10.0, flexure(STIFF, side)
    shift = part.bent(v, 0.0)[:, 0] - part.rest[:, 0]
    s = np.linspace(0.0, 1.0, BEAM_RINGS)
    curve = v / 2 * (3 * s**2 - 2 * s**3)
    for x in INNER:
        np.testing.assert_allclose(centre(shift, beam(part, x)), curve, atol=0.01)
    for x in OUTER:
        np.testing.assert_allclose(centre(shift, beam(part, x)), v - curve, atol=0.01)


def test_a_turned_shuttle_carries_the_roots_of_its_beams_and_their_slope() -> None:
    """At the root of an outer beam (-theta y, theta x), and the beam leaves it at the angle of the shuttle."""
    turn, part = 0.02, flexure(LAYOUT, 1)
    s = np.linspace(0.0, 1.0, BEAM_RINGS)
    for x in OUTER:
        moved = centre(part.follow @ np.array((0.0, 0.0, turn)), beam(part, x))
        np.testing.assert_allclose(moved[0], (-turn * 37.5, turn * x), atol=1e-9)
        slope = np.polyval(np.polyder(np.polyfit(350.0 * s, moved[:, 0], 3)), 0.0)
        assert slope == pytest.approx(-turn, rel=1e-6)
    for x in INNER:
        np.testing.assert_allclose(centre(part.follow, beam(part, x))[0], 0.0, atol=1e-12)


def test_the_energy_of_the_drawn_curves_is_that_of_the_suspension() -> None:
    """The sum of EI/2 of the integral of w''^2 over all beams and trusses is k/2, with k of equation 1.3.4."""
    g, energy = LAYOUT.geometry, 0.0
    part = flexure(LAYOUT, 1)
    counts = [BEAM_RINGS] * 4 + [TRUSS_RINGS] * 3
    first = 0
    for rings in counts:
        rows = slice(4 * first, 4 * (first + rings))
        first += rings
        points = part.rest[rows].reshape(rings, 4, 3).mean(1)
        moved = part.follow[rows, :, 0].reshape(rings, 4, 2).mean(1)
        along = int(np.ptp(points[:, 1]) > np.ptp(points[:, 0]))
        width = g.beam_um if along else g.truss_um
        second = np.polyder(np.polyfit(points[:, along] - points[0, along], moved[:, 1 - along], 3), 2)
        area = np.polyint(np.polymul(second, second))
        length = points[-1, along] - points[0, along]
        energy += 164e3 * g.thickness_um * width**3 / 12 / 2 * abs(np.polyval(area, length))
    assert 2 * energy == pytest.approx(g.stiffness_n_m() / 2, rel=5e-3)  # of one side
    # the missing part is in stretched beams, which no curve shows
    assert 4 * energy == pytest.approx(stiffness(g)[0, 0], rel=2e-3)


def test_an_adhesion_holds_its_point_of_its_beam() -> None:
    for where, x in (("inner", 15.0), ("outer", 45.0)):
        part = flexure(LAYOUT, 1, Damage(adhesion=(where, 0.7)))  # type: ignore[arg-type]
        held = centre(part.follow, beam(part, x))
        np.testing.assert_allclose(held[7], 0.0, atol=1e-9)
        assert np.abs(centre(part.follow, beam(part, -x))[7, 0, 0]) > 0.02
    # between anchor and adhesion an inner beam cannot move at all
    part = flexure(LAYOUT, 1, Damage(adhesion=("inner", 0.7)))
    np.testing.assert_allclose(centre(part.follow, beam(part, 15.0))[:8], 0.0, atol=1e-9)


def test_a_lost_truss_is_gone_and_its_beams_are_free() -> None:
    whole, end = flexure(LAYOUT, 1), flexure(LAYOUT, 1, Damage(lost_ends=(2,)))
    assert len(whole.rest) - len(end.rest) == 4 * TRUSS_RINGS
    part = flexure(LAYOUT, 1, Damage(lost_ends=(0, 1, 2)))
    assert len(part.rest) == 4 * 4 * BEAM_RINGS
    for x in INNER:
        np.testing.assert_allclose(centre(part.follow, beam(part, x)), 0.0, atol=1e-9)
    for x in OUTER:  # carried rigidly
        rows = beam(part, x)
        turned = centre(part.follow @ np.array((1.0, 0.0, 0.01)), rows)
        np.testing.assert_allclose(turned[:, 0], 1.0 - 0.01 * centre(part.rest, rows)[:, 1], atol=1e-6)


def test_damage_comes_by_its_share_and_stays_on_its_side() -> None:
    damage = Damage(adhesion=("inner", 0.75))
    parts = [flexure(LAYOUT, 1, damage, share).follow for share in (0.0, 0.5, 1.0)]
    np.testing.assert_allclose(parts[0], flexure(LAYOUT, 1).follow)
    np.testing.assert_allclose(parts[1], (parts[0] + parts[2]) / 2)
    np.testing.assert_allclose(flexure(LAYOUT, -1, damage).follow, flexure(LAYOUT, -1).follow, atol=1e-9)


def test_faces_close_over_the_vertices() -> None:
    for damage in (None, Damage(lost_ends=(2,))):
        part = flexure(LAYOUT, 1, damage)
        assert set(part.faces.ravel()) == set(range(len(part.rest)))
