"""The fringing of combs against a grid of the same cross-section, its limits, and the devices that have it."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import sparse
from scipy.sparse.linalg import spsolve

from core.device.catalogue import device
from core.device.drawn import device_of
from core.device.fringing import Fringing, fringing_factor
from core.errors import InputError

WIDTH = THICKNESS = HEIGHT = 2.0


def charge_of_grid(gap: float, step: float, has_rotor: bool, has_plane: bool) -> float:
    """Return the capacitance per length of a finger over the permittivity, on a five-point grid of half a pitch."""
    half, far = WIDTH + gap, 4.0 * (WIDTH + gap)
    bottom = -HEIGHT if has_plane else -far
    x = np.arange(round(half / step) + 1) * step
    y = bottom + np.arange(round((THICKNESS + far - bottom) / step) + 1) * step
    near = 1e-6 * step
    level = (y >= -near) & (y <= THICKNESS + near)
    stator = np.outer(x <= 0.5 * WIDTH + near, level)
    rotor = np.outer(x >= half - 0.5 * WIDTH - near, level) & has_rotor
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
