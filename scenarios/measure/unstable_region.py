"""The unstable region of a board: folds under a slow drive, and the boundary in displacement and velocity."""

from __future__ import annotations

from pydantic import BaseModel

from core.board.board import Board
from core.plant.body import worst
from core.plant.equilibrium import FoldPoint, Force, folds, planar_force, slaved_force, stators_of
from core.plant.escape import boundary
from core.plant.shuttle import LEFT, RIGHT, comb_voltage
from core.plant.suspension import Suspension


class SafeBoundary(BaseModel):
    """The speed beyond which the energy suffices to reach the stators, along x."""

    x_um: list[float]
    speed_um_ms: list[float]


class UnstableRegionMap(BaseModel):
    """The region where a bench as it is now pulls in; empty if its plant cannot."""

    tick: int
    plant: str
    drive_v: float
    folds: list[FoldPoint]
    boundary: SafeBoundary | None


def unstable_region(board: Board, drive_v: float = 0.0) -> UnstableRegionMap:
    """Return the unstable region of a board with the faults it has now.

    Parameters
    ----------
    board : Board
        At any tick; faults show in the planar plant from the tick after they came.
    drive_v : float
        Voltage held on the shuttle for the boundary.
    """
    kind = board.spec.plant.block.name
    p, state = board.wiring.parameters("plant"), board.wiring.state("plant")
    if kind == "slaved_lateral":
        ratio = float(p.ratio)
        force: Force = slaved_force(p, float(p.stiffness_n_m) * board.value("effects.stiffness_scale"))
        ends = folds(force, stators_of(p), lambda q: ratio * float(q[0]), 1)
        size = 1
    elif kind == "planar" and board.tick > 0:
        force = planar_force(p, Suspension(state.suspension.array.copy()))
        ends = folds(force, stators_of(p), lambda q: float(worst(p, float(q[1]), float(q[2]))), 3)
        size = 3
    else:
        return UnstableRegionMap(tick=board.tick, plant=kind, drive_v=drive_v, folds=[], boundary=None)
    mass = float(p.mass) * board.value("effects.mass_scale")
    first, second = stators_of(p)
    short = board.value("plant.short")
    right, left = comb_voltage(first - drive_v, short, RIGHT), comb_voltage(second - drive_v, short, LEFT)
    edge = boundary(force, mass, right * right, left * left, size)
    return UnstableRegionMap(
        tick=board.tick,
        plant=kind,
        drive_v=drive_v,
        folds=ends,
        boundary=edge and SafeBoundary(x_um=edge.x_um.tolist(), speed_um_ms=edge.speed_um_ms.tolist()),
    )
