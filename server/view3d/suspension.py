r"""Beams and trusses in their true shape: cubics between the ends, and ends that follow the shuttle.

Between two nodes nothing loads a beam, so its shape is the cubic with their displacements and rotations. The nodes
follow the shuttle as the static frame of beams does, damaged or not: :math:`r=r_0+F\,(x,y,\theta)^T` for each vertex.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.device import frame
from core.device.frame import Damage
from server.view3d.layout import UM_PER_UNIT, FloatArray, IntArray, Layout

BEAM_RINGS, TRUSS_RINGS = 11, 4


@dataclass(frozen=True)
class Flexure:
    """The suspension of one side.

    Parameters
    ----------
    rest : ndarray, shape (vertices, 3)
        Places of the vertices without load, um.
    follow : ndarray, shape (vertices, 2, 3)
        Their displacement along x and y per displacement (x, y, theta) of the shuttle.
    faces : ndarray, shape (triangles, 3)
        The surface.
    """

    rest: FloatArray
    follow: FloatArray
    faces: IntArray

    def bent(self, x: float, y: float, turn: float) -> FloatArray:
        """Return the vertices in scene units, for a displacement of the shuttle in um and rad."""
        moved = self.rest.copy()
        moved[:, :2] += self.follow @ np.array((x, y, turn))
        return moved / UM_PER_UNIT


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
    rest, follow, faces, first = [], [], [], 0
    for name, (points, healthy) in whole.items():
        if name[0] == "truss" and name[1] in lost:
            continue
        moving = healthy + share * (hurt[name][1] - healthy) if name in hurt else healthy
        width = layout.truss_um if name[0] == "truss" else layout.beam_um
        across = np.array([0.0, width / 2, 0.0]) if name[0] == "truss" else np.array([width / 2, 0.0, 0.0])
        up = np.array([0.0, 0.0, layout.thick_um / 2])
        ring = np.stack([-across - up, across - up, across + up, up - across])
        rest.append((points[:, None, :] + ring[None, :, :]).reshape(-1, 3))
        follow.append(np.repeat(moving, 4, axis=0))
        faces.append(tube(len(points)) + first)
        first += 4 * len(points)
    return Flexure(np.vstack(rest), np.vstack(follow), np.vstack(faces))


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


def tube(rings: int) -> IntArray:
    """Return the faces of a tube of square rings, closed at both ends."""
    faces = [[0, 1, 2], [0, 2, 3]]
    for a in range(0, 4 * (rings - 1), 4):
        for i in range(4):
            j = (i + 1) % 4
            faces += [[a + i, a + j, a + 4 + j], [a + i, a + 4 + j, a + 4 + i]]
    last = 4 * (rings - 1)
    return np.array([*faces, [last, last + 2, last + 1], [last, last + 3, last + 2]])
