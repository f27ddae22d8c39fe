"""The fringing of combs against a grid of the same cross-section, its limits, and the devices that have it."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import sparse
from scipy.sparse.linalg import spsolve

from core.device.catalogue import device
from core.device.drawn import device_of
from core.device.fringing import Fringing, fringing_factor
from core.device.levitation import lift_um, vertical_force
from core.errors import InputError

WIDTH = THICKNESS = HEIGHT = 2.0


def charge_of_grid(gap: float, step: float, has_rotor: bool, has_plane: bool, rise: float = 0.0) -> float:
    """Return the capacitance per length of a finger over the permittivity, on a five-point grid of half a pitch."""
    half, far = WIDTH + gap, 4.0 * (WIDTH + gap)  # all lengths are multiples of the coarsest step
    bottom = -HEIGHT if has_plane else -far
    x = np.arange(round(half / step) + 1) * step
    y = bottom + np.arange(round((THICKNESS + far - bottom) / step) + 1) * step
    near = 1e-6 * step
    level = (y >= -near) & (y <= THICKNESS + near)
    stator = np.outer(x <= 0.5 * WIDTH + near, level)
    raised = (y >= rise - near) & (y <= THICKNESS + rise + near)
    rotor = np.outer(x >= half - 0.5 * WIDTH - near, raised) & has_rotor
    plane = np.outer(np.ones(len(x), bool), (y <= bottom + near) & has_plane)
    number = np.arange(stator.size).reshape(stator.shape)
    across, along = np.ones((len(x) - 1, len(y))), np.ones((len(x), len(y) - 1))
    across[:, [0, -1]] *= 0.5
    along[[0, -1]] *= 0.5
    one = np.concatenate([number[:-1].ravel(), number[:, :-1].ravel()])
    other = np.concatenate([number[1:].ravel(), number[:, 1:].ravel()])
    weight = np.concatenate([across.ravel(), along.ravel()])
    links = sparse.coo_matrix((weight, (one, other)), shape=(stator.size, stator.size)).tocsr()
    links = links + links.T
    laplace = sparse.diags(np.asarray(links.sum(axis=1)).ravel()) - links
    volts = stator.ravel().astype(float)
    free = np.flatnonzero(~(stator | rotor | plane).ravel())
    volts[free] = spsolve(laplace[free][:, free].tocsc(), -(laplace[free] @ volts))
    return float(2.0 * volts @ (laplace @ volts))


def factor_of_grid(gap: float, step: float, has_plane: bool) -> float:
    alone = charge_of_grid(gap, step, has_rotor=False, has_plane=True) if has_plane else 0.0
    return (charge_of_grid(gap, step, has_rotor=True, has_plane=has_plane) - alone) * gap / (2.0 * THICKNESS)


def extrapolated(coarse: float, middle: float, fine: float) -> float:
    """Return the limit of three grids, each half as wide as the one before (Aitken)."""
    return fine - (fine - middle) ** 2 / ((fine - middle) - (middle - coarse))


def lift_of_grid(gap: float, step: float, move: float) -> float:
    """Return the vertical force on a rotor finger over permittivity and squared volt, from the energy of two places."""
    up, down = (charge_of_grid(gap, step, has_rotor=True, has_plane=True, rise=sign * move) for sign in (1, -1))
    return 0.25 * (up - down) / move


@pytest.mark.parametrize("gap", [1.0, 2.0, 4.0])
def test_the_vertical_force_is_the_slope_of_the_energy_on_a_grid(gap: float) -> None:
    limit = extrapolated(*(lift_of_grid(gap, step, 0.5) for step in (0.5, 0.25, 0.125)))
    forces = [vertical_force(WIDTH, gap, THICKNESS, HEIGHT, rise)[0] for rise in (-0.5, 0.0, 0.5)]
    mean = (forces[0] + 4.0 * forces[1] + forces[2]) / 6.0  # over the way of the grid, by Simpson's rule
    assert mean == pytest.approx(limit, rel=0.02)


@pytest.mark.long
@pytest.mark.parametrize("gap", [1.0, 1.5, 2.0, 2.5, 3.0, 4.0])
def test_a_grid_halved_twice_gives_the_same_vertical_force_within_a_percent(gap: float) -> None:
    limit = extrapolated(*(lift_of_grid(gap, step, 0.25) for step in (0.25, 0.125, 0.0625)))
    forces = [vertical_force(WIDTH, gap, THICKNESS, HEIGHT, rise)[0] for rise in (-0.25, 0.0, 0.25)]
    assert (forces[0] + 4.0 * forces[1] + forces[2]) / 6.0 == pytest.approx(limit, rel=0.01)


def test_a_shuttle_lifts_until_its_beams_balance_the_field() -> None:
    comb, pull, beams = (1.9, 2.1, 2.0, 2.0), 2.0, 0.09
    rise = lift_um(*comb, pull, beams)
    assert 0.3 < rise < 1.0
    assert pull * vertical_force(*comb, rise)[0] == pytest.approx(beams * rise, rel=1e-6)
    slope = (vertical_force(*comb, 0.01)[0] - vertical_force(*comb, -0.01)[0]) / 0.02
    assert vertical_force(*comb)[1] == pytest.approx(-slope, rel=1e-3)
    assert lift_um(*comb, 1e-4, beams) == pytest.approx(1e-4 * vertical_force(*comb)[0] / beams, rel=1e-2)


def test_a_device_lifts_above_a_plane_alone_and_as_far_as_its_beams_are_known() -> None:
    above = {"id": "lcr-350", "fringing": "grounded_plane"}
    found, free = device({**above, "bias_v": 10.0}).metrics(), device({**above, "fringing": "free"}).metrics()
    assert found["levitation_nn_per_v2"] == pytest.approx(5.75, rel=0.01)
    assert found["lift_nm"] == pytest.approx(903.0, rel=0.01)
    assert device({**above, "bias_v": 20.0}).metrics()["lift_nm"] > found["lift_nm"]
    assert not {"levitation_nn_per_v2", "lift_nm"} & free.keys()
    given = {"id": "ch3", "fringing": "grounded_plane", "fingers": 87, "thickness_um": 2.0, "finger_gap_um": 2.1}
    bare = device({**given, "force_n_per_v": None}).metrics()
    assert "levitation_nn_per_v2" in bare and "lift_nm" not in bare


@pytest.mark.long
@pytest.mark.parametrize("fringing", ["grounded_plane", "free"])
@pytest.mark.parametrize("gap", [1.0, 1.5, 2.0, 2.5, 3.0, 4.0])
def test_a_grid_halved_twice_gives_the_same_force_within_a_percent(gap: float, fringing: Fringing) -> None:
    grids = [factor_of_grid(gap, step, fringing == "grounded_plane") for step in (0.25, 0.125, 0.0625)]
    limit = extrapolated(*grids)
    assert fringing_factor(fringing, WIDTH, gap, THICKNESS, HEIGHT) == pytest.approx(limit, rel=0.005)


@pytest.mark.parametrize("fringing", ["grounded_plane", "free"])
def test_a_coarse_grid_gives_the_same_force(fringing: Fringing) -> None:
    grids = [factor_of_grid(2.0, step, fringing == "grounded_plane") for step in (0.5, 0.25, 0.125)]
    assert fringing_factor(fringing, WIDTH, 2.0, THICKNESS, HEIGHT) == pytest.approx(extrapolated(*grids), rel=0.01)


def test_thick_combs_pull_like_plates_and_a_high_plane_is_like_none() -> None:
    assert fringing_factor("free", 2.0, 2.0, 20.0, 2.0) == pytest.approx(1.0, abs=0.12)
    assert fringing_factor("free", 2.0, 2.0, 20.0, 2.0) < fringing_factor("free", 2.0, 2.0, 2.0, 2.0) < 2.2
    near, middle, high = (fringing_factor("grounded_plane", 2.0, 2.0, 2.0, height) for height in (1.0, 4.0, 20.0))
    free = fringing_factor("free", 2.0, 2.0, 2.0, 2.0)
    assert near < middle < high < free


def test_the_scale_of_a_drawing_does_not_matter() -> None:
    one, hundred = (
        fringing_factor("grounded_plane", *(scale * size for size in (1.9, 2.1, 2.0, 2.0))) for scale in (1, 100)
    )
    assert one == pytest.approx(hundred, rel=1e-12)


def test_a_device_with_fringing_has_more_force_and_the_others_have_theirs() -> None:
    plain, above = device({"id": "lcr-350"}), device({"id": "lcr-350", "fringing": "grounded_plane"})
    factor = fringing_factor("grounded_plane", 1.9, 2.1, 2.0, plain.drawing.film_gap_um)
    assert above.capacitance_gradient == plain.capacitance_gradient * factor
    assert above.metrics()["fringing_factor"] == factor and "fringing_factor" not in plain.metrics()
    assert above.metrics()["static_gain_um_per_v"] == pytest.approx(factor * plain.metrics()["static_gain_um_per_v"])


def test_a_given_force_contains_the_fringing_whatever_the_comb() -> None:
    given = {"id": "lcr-350", "force_n_per_v": 1e-8}
    alone, beside = device(given), device({**given, "fringing": "free", "geometry": {"thickness_um": 50.0}})
    assert beside.capacitance_gradient == alone.capacitance_gradient == 1e-8 / (2.0 * alone.bias_v)
    assert "fringing_factor" not in beside.metrics()


def test_a_device_of_a_class_keeps_the_force_of_its_fringing() -> None:
    plain, above = device({"id": "lcr-350"}), device({"id": "lcr-350", "fringing": "grounded_plane"})
    without, drawn = device_of(plain, 5), device_of(above, 5)
    values = {path.removeprefix("device."): value for path, value in drawn.items()}
    made = device({"id": "lcr-350", "fringing": "grounded_plane", **values})
    assert abs(made.signed_force_n_per_v) == pytest.approx(drawn["device.force_n_per_v"], rel=1e-15)
    ratio = drawn["device.force_n_per_v"] / without["device.force_n_per_v"]
    assert ratio == pytest.approx(above.fringing_factor, rel=1e-12)
    assert {**drawn, "device.force_n_per_v": 0} == {**without, "device.force_n_per_v": 0}


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ({"id": "lcr-350", "fringing": "some"}, ["fringing", "grounded_plane", "free"]),
        (
            {"id": "lcr-350", "fringing": "free", "geometry": {"thickness_um": 50.0}},
            ["thickness / finger_gap", "0.1 to 10"],
        ),
        ({"id": "gyro-a", "fringing": "free"}, ["fringing", "gyroscope"]),
    ],
)
def test_fringing_that_means_nothing_is_refused(table: dict[str, object], words: list[str]) -> None:
    with pytest.raises(InputError) as caught:
        device(table)
    assert all(word in str(caught.value) for word in words), str(caught.value)
