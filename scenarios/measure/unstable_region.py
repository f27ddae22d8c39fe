"""The unstable region of a board: folds under a slow drive, and the boundary in displacement and velocity."""

from __future__ import annotations

from dataclasses import dataclass

from core.board.board import Board
from core.plant.body import worst
from core.plant.equilibrium import Fold, Force, folds, planar_force, slaved_force, stators_of
from core.plant.escape import Boundary, boundary
from core.plant.shuttle import LEFT, RIGHT, comb_voltage
from core.plant.suspension import Suspension


@dataclass(frozen=True)
class UnstableRegion:
    """Folds to either side, and the boundary with the drive held; both are empty if the plant cannot pull in."""

    plant: str
    folds: list[Fold]
    boundary: Boundary | None


def unstable_region(board: Board, drive_v: float = 0.0) -> UnstableRegion:
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
        return UnstableRegion(kind, [], None)
    mass = float(p.mass) * board.value("effects.mass_scale")
    first, second = stators_of(p)
    short = board.value("plant.short")
    right, left = comb_voltage(first - drive_v, short, RIGHT), comb_voltage(second - drive_v, short, LEFT)
    return UnstableRegion(kind, ends, boundary(force, mass, right * right, left * left, size))
