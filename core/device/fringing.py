r"""The fringing of a comb: its force over the force of plates, from the field in its cross-section (1.5).

When the shuttle moves by dx, a length dx of engaged comb takes the place of stator fingers alone, so each rotor finger
has

.. math:: \frac{dC}{dx}=C'_{engaged}-C'_{stator\ alone},\qquad \frac{dC}{dx}\Big|_{plates}=\frac{2\varepsilon_0t}{g},

with the capacitances C' per length of two-dimensional cross-sections, whose fingers repeat with the pitch
:math:`P=2(w+g)`. The rotor, and a plane below, are grounded. The charges on the fingers follow from their potential by
the method of moments: constant on each panel, panels shorter towards the corners, and the potential of a row of line
charges :math:`\lambda`

.. math:: \varphi=-\frac\lambda{4\pi\varepsilon_0}\ln\left[2\cosh\frac{2\pi y}P-2\cos\frac{2\pi x}P\right].

A plane is the mirror image of all charges; without it the net charge of the cross-section is zero.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise
from math import pi
from typing import Literal

import numpy as np

from core.block import FloatArray
from core.elementary.circle import cos, sin
from core.elementary.exponential import exp
from core.elementary.logarithm import log
from core.errors import InputError
from core.kernel import kernel
from core.matrix import solved

Fringing = Literal["grounded_plane", "free"]
PANELS = 6
"""Panels on half of a finger's lower and upper side each; the flank has twice as many. With 12, the factor changes by
less than a thousandth."""
LEAST, MOST = 0.1, 10.0
"""Thickness, width and height above the plane over the gap, between which the factor is checked (0.5 %)."""
NODES = np.array(
    [
        (-0.8611363115940526, 0.17392742256872692),
        (-0.3399810435848563, 0.32607257743127307),
        (0.3399810435848563, 0.32607257743127307),
        (0.8611363115940526, 0.17392742256872692),
    ]
)
"""Nodes and weights of the Gauss rule of a panel."""


def fringing_factor(fringing: Fringing, width_um: float, gap_um: float, thickness_um: float, height_um: float) -> float:
    """Return dC/dx over dC/dx of plates.

    Parameters
    ----------
    fringing : str
        ``grounded_plane`` below the fingers, or ``free`` without a plane.
    width_um, gap_um, thickness_um : float
        Of the fingers, as etched.
    height_um : float
        Of the fingers above the plane.

    Raises
    ------
    InputError
        For proportions outside the checked range.
    """
    sizes = {"finger_width": width_um, "thickness": thickness_um}
    if fringing == "grounded_plane":
        sizes["film_gap"] = height_um
    for name, size in sizes.items():
        if not LEAST <= size / gap_um <= MOST:
            text = f"knows combs with {name} / finger_gap from {LEAST:g} to {MOST:g}, here it is {size / gap_um:.3g}"
            raise InputError(text, "device.fringing", "leave fringing out")
    return _factor(fringing == "grounded_plane", width_um, gap_um, thickness_um, height_um)


@lru_cache(maxsize=4096)
def _factor(has_plane: bool, width: float, gap: float, thickness: float, height: float) -> float:
    finger = finger_panels(width, thickness)
    rotor = finger.copy()
    rotor[:, ::2] = width + gap - finger[:, ::2]
    engaged = charge(np.concatenate([finger, rotor]), len(finger), has_plane, 2.0 * (width + gap), height)
    alone = charge(finger, len(finger), True, 2.0 * (width + gap), height) if has_plane else 0.0
    return (engaged - alone) * gap / (2.0 * thickness)


def finger_panels(width: float, thickness: float) -> FloatArray:
    """Return the ends (x, y, x, y) of panels around the right half of a finger that is centred at x = 0."""
    half = 0.5 * width
    corner = [cos(0.5 * pi * step / PANELS) for step in range(PANELS + 1)]  # 1 to 0, closer together at 1
    up = [0.5 * thickness * (1.0 - cos(0.5 * pi * step / PANELS)) for step in range(2 * PANELS + 1)]
    below = [(half * share, 0.0) for share in reversed(corner)]
    above = [(half * share, thickness) for share in corner]
    nodes = [*below, *((half, y) for y in up[1:-1]), *above]
    return np.array([(*one, *other) for one, other in pairwise(nodes)])


def charge(panels: FloatArray, driven: int, has_plane: bool, pitch: float, height: float) -> float:
    """Return the charge per length of a finger at 1 V over the permittivity; the others, and the plane, are at 0 V."""
    count = len(panels)
    lengths = np.abs(panels[:, 2] - panels[:, 0]) + np.abs(panels[:, 3] - panels[:, 1])  # along an axis
    matrix, volts = np.zeros((count + 1, count + 1)), np.zeros(count + 1)
    _influence(panels, lengths, NODES, pitch, height if has_plane else -1.0, matrix)
    volts[:driven] = 1.0
    if has_plane:
        matrix[count, count] = 1.0
    else:  # the unknown potential far away, and no net charge
        matrix[:count, count] = 1.0
        matrix[count, :count] = lengths
    charges = solved(matrix, volts)
    return 2.0 * float(sum((charges[:driven] * lengths[:driven]).tolist()))


@kernel
def _potential(x: float, y: float, pitch: float) -> float:
    """Return the potential of a row of line charges, times the permittivity, without the log of a squared distance."""
    rise = 2.0 * pi * abs(y) / pitch
    decay = exp(-rise)
    half = sin(pi * x / pitch)
    return -(rise + log((1.0 - decay) * (1.0 - decay) + 4.0 * decay * half * half)) / (4.0 * pi)


@kernel
def _influence(
    panels: FloatArray, lengths: FloatArray, nodes: FloatArray, pitch: float, height: float, matrix: FloatArray
) -> None:
    """Write the potential that a unit density on each panel gives to the middle of each; no plane: a height below 0."""
    count = panels.shape[0]
    for i in range(count):
        x, y = 0.5 * (panels[i, 0] + panels[i, 2]), 0.5 * (panels[i, 1] + panels[i, 3])
        for j in range(count):
            length = lengths[j]
            total = 0.0
            for node in range(nodes.shape[0]):
                place, weight = nodes[node, 0], nodes[node, 1]
                u = 0.5 * (panels[j, 0] + panels[j, 2]) + 0.5 * place * (panels[j, 2] - panels[j, 0])
                v = 0.5 * (panels[j, 1] + panels[j, 3]) + 0.5 * place * (panels[j, 3] - panels[j, 1])
                value = _potential(x + u, y - v, pitch) + _potential(x - u, y - v, pitch)
                if i == j:  # the singular part is integrated below
                    distance = pi * place * length / pitch
                    value += log(distance * distance) / (4.0 * pi)
                if height >= 0.0:
                    value -= _potential(x + u, y + v + 2.0 * height, pitch)
                    value -= _potential(x - u, y + v + 2.0 * height, pitch)
                total += weight * length * value
            if i == j:
                total -= length * (log(pi * length / pitch) - 1.0) / (2.0 * pi)
            matrix[i, j] = total
