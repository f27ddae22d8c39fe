r"""Beams and trusses in their true shape: cubics between the ends, and ends that follow the shuttle.

Between two nodes nothing loads a beam, so its shape is the cubic with their displacements and rotations. The nodes
follow the shuttle as the static frame of beams does, damaged or not.
"""

from __future__ import annotations

import numpy as np

from core.device import frame
from core.device.frame import Damage
from server.view3d.flexure import Flexure, join, swept
from server.view3d.resonator.layout import Layout
from server.view3d.solids import FloatArray

BEAM_RINGS, TRUSS_RINGS = 11, 4


def flexure(layout: Layout, side: int, damage: Damage | None = None, share: float = 1.0) -> Flexure:
    """Return the suspension of the side at +y or -y.

    Parameters
    ----------
    layout : Layout
        Where the parts are.
    side : int
        1 or -1.
    damage : Damage, optional
        Damage of the side at +y.
    share : float
        Present share of the damage; a truss breaks off at the whole of it.
    """
    whole = _lines(layout, side, frame.shape(layout.geometry))
    hurt = whole if damage is None else _lines(layout, side, frame.shape(layout.geometry, damage))
    lost = damage.lost_ends if damage is not None and side > 0 and share >= 1.0 else ()
    parts = []
    for name, (points, healthy) in whole.items():
        is_truss = name[0] == "truss"
        if is_truss and name[1] in lost:
            continue
        moving = healthy + share * (hurt[name][1] - healthy) if name in hurt else healthy
        across = np.array([0.0, layout.truss_um / 2, 0.0] if is_truss else [layout.beam_um / 2, 0.0, 0.0])
        parts.append(swept(points, moving, across, layout.thick_um))
    return join(parts)


def _lines(layout: Layout, side: int, shape: frame.Shape) -> dict[tuple[str, int], tuple[FloatArray, FloatArray]]:
    """Return the centre line of every beam and truss segment: points, and how they follow the shuttle."""
    lines = {}
    segment = layout.geometry.truss_segment_um
    chains: dict[tuple[str, int], list[tuple[int, int]]] = {}
    for a, b in shape.elements:
        (xa, ya), (xb, _) = shape.points[[a, b]]
        if side * ya > 0.0:
            name = ("beam", round(xa / segment + 1.5)) if xa == xb else ("truss", round(xa / segment + 1.5))
            chains.setdefault(name, []).append((a, b))
    for name, chain in chains.items():
        rings = BEAM_RINGS if name[0] == "beam" else TRUSS_RINGS
        ends = shape.points[[chain[0][0], chain[-1][1]]]
        s = np.linspace(0.0, 1.0, rings)
        follow = np.stack([_followed(shape, chain, ends[0] + share * (ends[1] - ends[0])) for share in s])
        x = ends[0, 0] + s * (ends[1, 0] - ends[0, 0])
        y = side * np.abs(ends[0, 1] + s * (ends[1, 1] - ends[0, 1]))
        if name[0] == "truss":
            y = y + side * layout.truss_um / 2
        lines[name] = (np.column_stack([x, y, np.full(rings, layout.z)]), follow)
    return lines


def _followed(shape: frame.Shape, chain: list[tuple[int, int]], point: FloatArray) -> FloatArray:
    r"""Return how a point between nodes follows the shuttle.

    .. math:: w(t)=(1-3t^2+2t^3)\,w_a+(3t^2-2t^3)\,w_b+L\,[(t-2t^2+t^3)\,\theta_a+(t^3-t^2)\,\theta_b]
    """
    for a, b in chain:
        start, end = shape.points[a], shape.points[b]
        length = float(np.hypot(*(end - start)))
        along = (end - start) / length
        t = float((point - start) @ along) / length
        if t <= 1.0 + 1e-9:
            break
    across = np.array([-along[1], along[0]])
    first, last = shape.response[a], shape.response[b]
    stretched = (1.0 - t) * (along @ first[:2]) + t * (along @ last[:2])
    rise = 3.0 * t * t - 2.0 * t * t * t
    near, far = t - 2.0 * t * t + t * t * t, t * t * t - t * t
    bent = (1.0 - rise) * (across @ first[:2]) + rise * (across @ last[:2]) + length * (near * first[2] + far * last[2])
    return np.asarray(np.outer(along, stretched) + np.outer(across, bent))
