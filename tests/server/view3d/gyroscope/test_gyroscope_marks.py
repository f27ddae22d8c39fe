"""Every fault of a gyroscope is visible on its part, by its name; a fault without a drawing too."""

from __future__ import annotations

from functools import cache
from typing import Any, Literal

import numpy as np
import pytest

from core.board.instances import faults_of
from core.faults.fault import Fault, FaultParams
from core.ports import BlockPorts, output
from server.view3d.gyroscope.marks import GyroscopeMarks
from server.view3d.gyroscope.parts import DISC_UM, PITCH_UM, RIM_UM, STATOR_UM, TOP_UM
from server.view3d.pose import Active


@cache
def faults() -> dict[str, Any]:
    return dict(faults_of(("x", "y")))


class Paired(FaultParams):
    """A fault in the comb of an axis."""

    axis: Literal["x", "y"] = "y"


def named(called: str, severity: float, params: FaultParams | None = None, part: str = "beams") -> Active:
    """Return a fault of this name, whether the bench knows one or not."""

    class Called(Fault):
        title, shows = called.capitalize(), part

        class Ports(BlockPorts):
            severity: float = output("1", "how bad")

    Called.name = called
    return Active(Called, params or FaultParams(severity=severity), severity)


def shown(called: str, severity: float, params: FaultParams | None = None) -> GyroscopeMarks:
    return GyroscopeMarks([named(called, severity, params)])


def test_every_fault_says_what_it_is_within_the_picture() -> None:
    for name, block in faults().items():
        found = GyroscopeMarks([Active(block, block.Params(severity=block.suggested), block.suggested)])
        ((x, y, _), lines), *rest = found.labels.items()
        assert not rest and lines[0].startswith(block.title), name
        assert np.hypot(x, y) <= DISC_UM, name
        for mesh in found.solids.values():
            assert (np.abs(mesh.vertices[:, :2]) <= RIM_UM).all(), name


def test_a_fault_nobody_has_drawn_is_a_label() -> None:
    found = shown("unheard", 3.0)
    assert list(found.labels.values()) == [["Unheard"]] and not found.solids
    assert not any(found.tints.values())


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_quadrature_turns_both_axes_of_the_suspension(sign: float) -> None:
    for (name, mesh), k in zip(shown("quadrature", 500.0 * sign).solids.items(), (0, 1), strict=True):
        at = mesh.vertices
        end = at[at[:, k] > 0.9 * at[:, k].max()].mean(0)
        angle = np.arctan2(end[1], end[0]) - k * np.pi / 2
        assert angle == pytest.approx(0.15 * sign, abs=1e-6) and "/" not in name


def test_a_lost_drive_breaks_its_leads_and_tints_its_combs_alone() -> None:
    found = shown("drive_loss", 0.5)
    assert len(found.solids) == 2
    assert [found.tints[f"stators-{axis}"] for axis in "xy"] == [pytest.approx(0.65), 0.0]
    assert shown("drive_loss", 1.0).tints["stators-x"] == 1.0


def test_stiffness_of_the_sensing_axis_tints_its_beams_alone() -> None:
    tints = shown("sense_stiffness", 0.01).tints
    assert tints["flexures-y"] > 0.0 and tints["flexures-x"] == 0.0
    tints = GyroscopeMarks([Active(faults()["stiffness"], FaultParams(severity=0.1), 0.1)]).tints
    assert tints["flexures-x"] == tints["flexures-y"] > 0.0


@pytest.mark.parametrize(("axis", "k"), [("x", 0), ("y", 1)])
def test_a_shorted_pair_is_two_fingers_side_by_side_and_one_rides(axis: Literal["x", "y"], k: int) -> None:
    solids = shown("finger_pair_short", 1.0, Paired(severity=1.0, axis=axis)).solids
    assert list(solids) == [f"{axis}/shorted-moving", "shorted-fixed"]
    centres = [mesh.vertices.mean(0) for mesh in solids.values()]
    assert abs(centres[0][1 - k] - centres[1][1 - k]) == pytest.approx(PITCH_UM / 2)
    assert solids["shorted-fixed"].vertices[:, k].min() == pytest.approx(STATOR_UM, abs=2.0)
    assert "y/shorted-moving" in shown("finger_pair_short", 1.0).solids


def test_gas_a_mass_and_a_shock() -> None:
    assert shown("package_leak", 125.0).tints["gas"] == 1.0
    damping = GyroscopeMarks([Active(faults()["damping"], FaultParams(severity=0.1), 0.1)])
    assert 0.0 < damping.tints["gas"] < 1.0
    block = shown("added_mass", 0.1).solids["mass/added-mass"]
    assert block.vertices[:, 2].min() == pytest.approx(TOP_UM)
    for severity, axis, k in ((20.0, "x", 0), (-20.0, "y", 1)):
        solids = shown("shock", severity, Paired(severity=severity, axis=axis)).solids  # type: ignore[arg-type]
        along = solids["shock"].vertices[:, k]
        assert np.ptp(along) == pytest.approx(90.0)
        assert np.sign(along[3] - along.mean()) == np.sign(severity)
