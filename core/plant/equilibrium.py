"""Static equilibria of a plant, their folds, and pull-in."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from core.block import FloatArray
from core.kernel import kernel
from core.plant import slaved_lateral
from core.plant.electrostatics import comb
from core.plant.plane import Plane
from core.plant.shuttle import Shuttle
from core.plant.slaved_lateral import SlavedLateral
from core.plant.suspension import Suspension, elastic_force

Force = Callable[[FloatArray, float, float], FloatArray]
"""Generalised force at a place under two squared voltages."""


@dataclass(frozen=True)
class FoldPoint:
    """The last rest position under a slowly rising drive: travel, voltage, place of the worst corner sideways."""

    x_um: float
    volts: float
    lateral_um: float


def planar_force(p: Plane.Packed, suspension: Suspension) -> Force:
    """Return the static force of a planar plant."""

    def force(q: FloatArray, right: float, left: float) -> FloatArray:
        return np.array(static_force(p, suspension, q[0], q[1], q[2], right, left))

    return force


@kernel
def static_force(
    p: Plane.Packed, suspension: Suspension, x: float, y: float, theta: float, right: float, left: float
) -> tuple[float, float, float]:
    """Return the static forces, uN, and torque, uN um, of a planar plant under two squared voltages."""
    overlap = p.rotor_tip - p.stator_tip
    yy = y + p.misalignment_um
    tt = theta + p.misalignment_rad
    fx, fy, mz = elastic_force(suspension, x, y, theta)
    x1, y1, t1, _, _ = comb(p.gap_squared, p.limit, p.stator_tip, 0.5 * (overlap + x), 1.0, yy, tt)
    x2, y2, t2, _, _ = comb(p.gap_squared, p.limit, p.stator_tip, 0.5 * (overlap - x), -1.0, yy, tt)
    return (
        fx + p.strength * (right * x1 + left * x2),
        fy + p.strength * (right * y1 + left * y2),
        mz + p.strength * (right * t1 + left * t2),
    )


def slaved_force(p: SlavedLateral.Packed, stiffness: float) -> Force:
    """Return the static force of the slaved plant, a place of one number."""

    def force(q: FloatArray, right: float, left: float) -> FloatArray:
        x = q.item(0)
        return np.array([slaved_lateral.slaved_force(p, x, right, left) - stiffness * x])

    return force


SCALES = np.array([1e-5, 1e-6, 1e-8])
"""Steps of the numerical stiffness along x, y and theta."""


def jacobian(function: Callable[[FloatArray], FloatArray], at: FloatArray, scales: FloatArray) -> FloatArray:
    """Return the Jacobian of a function, by central differences over the steps given."""
    sizes = scales[: len(at)]
    steps = zip(np.diag(sizes), sizes, strict=True)
    return np.array([(function(at + h) - function(at - h)) / (2.0 * size) for h, size in steps]).T


def stiffness(force: Force, q: FloatArray, right: float, left: float) -> FloatArray:
    """Return minus the Jacobian of the force."""
    return -jacobian(lambda place: force(place, right, left), q, SCALES)


def is_minimum(k: FloatArray) -> bool:
    """Say whether a stiffness is positive in every direction: its least eigenvalue, scaled by its diagonal, is."""
    size = np.sqrt(np.abs(np.diag(k))) + 1e-300
    return bool(np.linalg.eigvalsh(0.5 * (k + k.T) / np.outer(size, size))[0] > 0.0)


def is_stable(force: Force, q: FloatArray, right: float, left: float) -> bool:
    """Say whether the energy has a minimum there."""
    return is_minimum(stiffness(force, q, right, left))


def squared(stators: tuple[float, float], v: float) -> tuple[float, float]:
    """Return the squared voltages at both combs under a voltage on the shuttle."""
    return (stators[0] - v) * (stators[0] - v), (stators[1] - v) * (stators[1] - v)


def rest_at(force: Force, start: FloatArray, right: float, left: float) -> FloatArray | None:
    """Return the equilibrium next to a place under given squared voltages, or none."""
    q = start.copy()
    for _ in range(60):
        try:
            move = np.linalg.solve(stiffness(force, q, right, left), force(q, right, left))
        except np.linalg.LinAlgError:
            return None
        q = q + move
        if not np.all(np.isfinite(q)) or abs(q[0]) > 30.0 or (len(q) > 1 and (abs(q[1]) > 2.0 or abs(q[2]) > 0.015)):
            return None
        if np.all(np.abs(move) < 1e-9 * SCALES / SCALES[-1] if len(q) == 3 else np.abs(move) < 1e-9):
            return q
    return None


def voltage_at(
    force: Force, x: float, start: FloatArray, stators: tuple[float, float]
) -> tuple[FloatArray, float] | None:
    """Return the place and the voltage on the shuttle for an equilibrium at a travel, by Newton's method."""
    q, v = start[:-1].copy(), float(start[-1])
    q[0] = x
    unknowns = np.append(q[1:], v)

    def residual(z: FloatArray) -> FloatArray:
        return force(np.append([x], z[:-1]), *squared(stators, float(z[-1])))

    scales = np.append(SCALES[1 : len(q)], 1e-5)
    for _ in range(40):
        try:
            move = np.linalg.solve(jacobian(residual, unknowns, scales), residual(unknowns))
        except np.linalg.LinAlgError:
            return None
        unknowns = unknowns - move
        if not np.all(np.isfinite(unknowns)):
            return None
        if np.all(np.abs(move) < 1e-4 * scales):
            return np.append([x], unknowns[:-1]), float(unknowns[-1])
    return None


def fold(
    force: Force,
    stators: tuple[float, float],
    lateral: Callable[[FloatArray], float],
    size: int,
    farthest: float = 20.0,
    step: float = 0.05,
) -> FoldPoint | None:
    """Return the first place, to either side, where the equilibrium becomes unstable as the drive rises.

    Parameters
    ----------
    force : callable
        Static force.
    stators : tuple of float
        Voltages of the stators.
    lateral : callable
        Displacement of the worst corner sideways at a place.
    size : int
        Coordinates of a place, 1 or 3.
    farthest, step : float
        Largest travel searched, and the step of the search, um.

    Returns
    -------
    FoldPoint or None
        The fold of the side that needs less voltage; None if both sides are stable over the travel searched. A device
        that is unstable without any drive has its fold at 0 V.
    """
    ends = folds(force, stators, lateral, size, farthest, step)
    return min(ends, key=lambda entry: abs(entry.volts)) if ends else None


def folds(
    force: Force,
    stators: tuple[float, float],
    lateral: Callable[[FloatArray], float],
    size: int,
    farthest: float = 20.0,
    step: float = 0.05,
) -> list[FoldPoint]:
    """Return the folds to either side that exist; arguments as for `fold`."""
    rest = rest_at(force, np.zeros(size), *squared(stators, 0.0))
    if rest is None or not is_stable(force, rest, *squared(stators, 0.0)):
        return [FoldPoint(0.0, 0.0, 0.0)]
    folds = [_one_side(force, stators, lateral, rest, side, farthest, step) for side in (1.0, -1.0)]
    return [entry for entry in folds if entry is not None]


def _one_side(
    force: Force,
    stators: tuple[float, float],
    lateral: Callable[[FloatArray], float],
    rest: FloatArray,
    side: float,
    farthest: float,
    step: float,
) -> FoldPoint | None:
    def stable(x: float, near: FloatArray) -> tuple[bool, FloatArray]:
        held = voltage_at(force, x, near, stators)
        if held is None:
            return False, near
        q, v = held
        return is_stable(force, q, *squared(stators, v)), np.append(q, v)

    last = np.append(rest, 0.0)
    x, pace = float(rest[0]), step
    while pace > 1e-7:
        good, state = stable(x + side * pace, last)
        if good:
            x, last = x + side * pace, state
            if abs(x) > farthest:
                return None
        else:
            pace *= 0.5
    return FoldPoint(x, float(last[-1]), lateral(last[:-1]))


def bias_pull_in(p: Plane.Packed, suspension: Suspension, highest: float = 400.0) -> float | None:
    """Return the bias, V on both stators with opposite signs, beyond which a planar plant has no stable rest."""
    force = planar_force(p, suspension)

    def at(volts: float, near: FloatArray) -> FloatArray | None:
        q = rest_at(force, near, volts * volts, volts * volts)
        return q if q is not None and is_stable(force, q, volts * volts, volts * volts) else None

    volts, step, place = 0.0, 1.0, np.zeros(3)
    while step > 1e-6:
        rest = at(volts + step, place)
        if rest is None:
            step *= 0.5
        else:
            volts, place = volts + step, rest
            if volts > highest:
                return None
    return volts


def stators_of(p: Shuttle.Packed) -> tuple[float, float]:
    """Return the voltages of the stators in packed parameters of a plant."""
    return float(p.first_v), float(p.second_v)
