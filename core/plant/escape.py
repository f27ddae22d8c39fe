"""Map of the unstable region: the speed at which the shuttle may pass each place without being pulled in."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from core.block import FloatArray
from core.plant.equilibrium import SCALES, Force, is_minimum, rest_at, stiffness


@dataclass(frozen=True)
class Boundary:
    """Places along x, um, and the speeds beyond which the energy suffices to cross the barrier, um/ms."""

    x_um: FloatArray
    speed_um_ms: FloatArray


def boundary(
    force: Force, mass: float, right: float, left: float, size: int, farthest: float = 20.0, step: float = 0.05
) -> Boundary | None:
    r"""Return the boundary of the motions that cannot pull in, under a held voltage.

    Along x the other coordinates are in equilibrium. With the energy :math:`U(x)=-\int F_x\,dx` of that path and its
    lower barrier :math:`U_b`, with or without damping, a motion with

    .. math:: \tfrac12mv^2+U(x)<U_b

    cannot leave. The barrier is the place where the force turns outwards, or where the other coordinates lose their
    equilibrium. Outside the boundary the shuttle may leave, and without damping it does if that barrier is ahead of it.

    Parameters
    ----------
    force : callable
        Static force.
    mass : float
        mg.
    right, left : float
        Squared voltages at the two combs.
    size : int
        Coordinates of a place, 1 or 3.
    farthest, step : float
        Largest travel searched, and the step of the search, um.

    Returns
    -------
    Boundary or None
        None if there is no barrier within the travel. Without any stable rest the boundary is one point.
    """
    rest = rest_at(force, np.zeros(size), right, left)
    if rest is None or _along(force, float(rest[0]), rest, right, left) is None:
        return Boundary(np.zeros(1), np.zeros(1))
    sides = [_climb(force, rest, side, right, left, farthest, step) for side in (1.0, -1.0)]
    barriers = [energy[-1] for _, energy, ends in sides if ends]
    if not barriers:
        return None
    barrier = min(barriers)
    x = np.concatenate([sides[1][0][:0:-1], sides[0][0]])
    energy = np.concatenate([sides[1][1][:0:-1], sides[0][1]])
    inside = energy <= barrier
    return Boundary(x[inside], np.sqrt(2.0 * (barrier - energy[inside]) / mass))


def _along(force: Force, x: float, near: FloatArray, right: float, left: float) -> tuple[FloatArray, float] | None:
    """Return place and force along x with the other coordinates at a stable rest, or none."""
    q = near.copy()
    q[0] = x
    for _ in range(40):
        if len(q) == 1:
            break
        block = stiffness(force, q, right, left)[1:, 1:]
        if not is_minimum(block):
            return None
        move = np.linalg.solve(block, force(q, right, left)[1:])
        q[1:] += move
        if not np.all(np.isfinite(q)) or abs(q[1]) > 2.0 or abs(q[2]) > 0.015:
            return None
        if np.all(np.abs(move) < 1e-3 * SCALES[1:]):
            break
    return q, float(force(q, right, left)[0])


def _climb(
    force: Force, rest: FloatArray, side: float, right: float, left: float, farthest: float, step: float
) -> tuple[FloatArray, FloatArray, bool]:
    """Walk outwards to the barrier: places, energies above rest, and whether there is one within the travel."""
    places, energies = [float(rest[0])], [0.0]
    q, before, pace = rest, 0.0, step
    while pace > 1e-4:
        x = places[-1] + side * pace
        if abs(x) > farthest:
            return np.array(places), np.array(energies), False
        reached = _along(force, x, q, right, left)
        if reached is None or side * reached[1] > 0.0:
            pace *= 0.5
            continue
        places.append(x)
        energies.append(energies[-1] - 0.5 * (before + reached[1]) * side * pace)
        q, before = reached
    return np.array(places), np.array(energies), math.isfinite(energies[-1])
