"""Where a board as it is now pulls in: folds under a slow drive, and the boundary in displacement and velocity."""

from __future__ import annotations

from dataclasses import dataclass

from core.board import program
from core.board.board import Board
from core.plant import body, slaved_lateral
from core.plant.equilibrium import Fold, Force, folds, planar_force, slaved_force, stators_of
from core.plant.escape import Boundary, boundary
from core.plant.shuttle import LEFT, MASS, RIGHT, comb_voltage


@dataclass(frozen=True)
class UnstableRegion:
    """Folds to either side, and the boundary with the drive held; neither where the plant cannot pull in."""

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
    wiring = board.wiring
    p = wiring.p[wiring.table[wiring.row("plant"), program.P_OFFSET] :]
    state = wiring.state_of("plant")
    mass = float(p[MASS]) * board.value("effects.mass_scale")
    if kind == "slaved_lateral":
        ratio = float(p[slaved_lateral.KAPPA])
        force: Force = slaved_force(p, float(p[slaved_lateral.SPRING]) * board.value("effects.stiffness_scale"))
        ends = folds(force, stators_of(p), lambda q: ratio * float(q[0]), 1)
        size = 1
    elif kind == "planar" and board.tick > 0:
        force = planar_force(p, state[:9].copy())
        ends = folds(force, stators_of(p), lambda q: float(body.worst(p, float(q[1]), float(q[2]))), 3)
        size = 3
    else:
        return UnstableRegion(kind, [], None)
    first, second = stators_of(p)
    short = board.value("plant.short")
    right, left = comb_voltage(first - drive_v, short, RIGHT), comb_voltage(second - drive_v, short, LEFT)
    return UnstableRegion(kind, ends, boundary(force, mass, right * right, left * left, size))
