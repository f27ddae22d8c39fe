"""Figures of the motion across the drive: folds, contact, pull-in."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from core.board.board import Board
from core.device.device import Device
from core.device.geometry import Geometry
from core.device.lateral import lateral
from core.device.pull_in import rotation_pull_in_v
from core.plant.body import worst
from core.plant.equilibrium import (
    FoldPoint,
    bias_pull_in,
    fold,
    is_stable,
    planar_force,
    slaved_force,
    squared,
    stators_of,
    voltage_at,
)
from core.plant.plane import Plane
from core.plant.suspension import Suspension

SMALL_UM = 1.0
"""Travel at which the rotation is measured."""


def lateral_metrics(board: Board) -> dict[str, float]:
    """Return the figures of a board as it is now, with the faults it has now.

    ``lateral.fold_um``, ``fold_v`` and ``fold_lateral_um`` are travel, drive and sideways displacement of the worst
    corner where the equilibrium under a slowly rising drive stops being stable; ``lateral.contact_ms`` is the moment
    of the first contact; ``lateral.far_ratio`` is the travel of the farthest finger over the centre's, where the
    shuttle rests at 1 um of travel in a stable equilibrium.
    ``device.pull_in_v`` is the bias beyond which the shuttle turns into the stators without any drive.
    """
    if board.tick == 0:
        return {}
    kind = board.spec.plant.block.name
    if kind not in ("slaved_lateral", "planar"):
        scale = board.value("effects.elasticity_scale") * board.value("effects.rotation_scale")
        volts = device_pull_in(board.spec.device, scale)
        return {} if volts is None else {"device.pull_in_v": volts}
    p, state = board.wiring.parameters("plant"), board.wiring.state("plant")
    if kind == "slaved_lateral":
        scale = board.value("effects.stiffness_scale")
        force = slaved_force(p, float(p.stiffness_n_m) * scale)
        ratio = float(p.ratio)
        return _folded(fold(force, stators_of(p), lambda q: ratio * float(q[0]), 1)) | _touched(float(state.touched_ms))
    return _planar(p, state, board.spec.device.drawing.far_finger_um)


def device_pull_in(device: Device, stiffness_scale: float = 1.0) -> float | None:
    r"""Return the bias of pull-in of a device, perfectly aligned; none where no comb could pull it in.

    A device without a drawing has the beams of LCR-350. The bias is proportional to the root of the stiffness against
    rotation; ``stiffness_scale`` is the factor of environment and faults on that stiffness.
    """
    volts = aligned_pull_in(device) if device.usual_plant == "linear" else None
    return None if volts is None else volts * math.sqrt(stiffness_scale)


def aligned_pull_in(device: Device) -> float | None:
    """Return the bias of pull-in of a resonator as it was made."""
    if device.capacitance_gradient == 0.0:
        return None
    return geometry_pull_in(device.drawing, device.capacitance_gradient)


@lru_cache(maxsize=256)
def geometry_pull_in(geometry: Geometry, gradient_f_m: float) -> float:
    """Return the bias of pull-in of a drawing, its rotational stiffness by the frame of beams."""
    across = lateral(geometry)
    return rotation_pull_in_v(
        across.rotation_stiffness_nm, gradient_f_m, across.gap_um, across.stator_tip_um, across.overlap_um
    )


def _planar(p: Plane.Packed, state: Plane.State, far_um: float) -> dict[str, float]:
    suspension = Suspension(state.suspension.array.copy())
    force, stators = planar_force(p, suspension), stators_of(p)
    figures = _folded(fold(force, stators, lambda q: float(worst(p, float(q[1]), float(q[2]))), 3))
    figures |= _touched(float(state.touched_ms))
    pull_in = bias_pull_in(p, suspension)
    if pull_in is not None:
        figures["device.pull_in_v"] = pull_in
    held = voltage_at(force, SMALL_UM, np.zeros(4), stators)
    if held is not None and is_stable(force, held[0], *squared(stators, held[1])):
        figures["lateral.far_ratio"] = 1.0 + abs(float(held[0][2])) * far_um / SMALL_UM
    return figures


def _folded(end: FoldPoint | None) -> dict[str, float]:
    if end is None:
        return {}
    return {
        "lateral.fold_um": abs(end.x_um),
        "lateral.fold_v": abs(end.volts),
        "lateral.fold_lateral_um": abs(end.lateral_um),
    }


def _touched(at_ms: float) -> dict[str, float]:
    return {} if at_ms < 0.0 else {"lateral.contact_ms": at_ms}
