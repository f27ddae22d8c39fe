r"""Effects beside mass, damper and spring: the residual each would leave, and the numbers it would pull along.

.. math:: e = J\delta + Aa,\qquad a = (A_\perp)^+e,\qquad \delta = -J^+Aa

With :math:`e` the residual of a fit, :math:`J` the changes of its output with its numbers, and :math:`A_\perp` the part
of the effect that no number takes up. A small :math:`a` that is none of chance may come with a large :math:`\delta`:
the numbers then belong to another device.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from scipy.signal import lfilter
from scipy.stats import chi2

from scenarios.records.columns import Numbers
from scenarios.records.fit import SKIPPED, Fit, response, transition

MODES = tuple(np.geomspace(0.3, 8.0, 60).tolist())
"""Second modes that are looked for, over the frequency of the device."""


@dataclass(frozen=True)
class Effect:
    """An effect, as far as it would explain a residual.

    Parameters
    ----------
    name : str
        In words.
    share : float
        Of the residual's power, beyond the numbers of the fit.
    chance : float
        Probability that noise alone explains as much.
    pull : array, shape (7,)
        Change of the numbers of the fit if the effect were part of the model, as `Fit.jacobian` has them.
    """

    name: str
    share: float
    chance: float
    pull: Numbers = field(repr=False)


def effects(fitted: Fit, drive: Numbers, dt_ms: float) -> Iterator[Effect]:
    """Return each effect that could be seen under this voltage."""
    left = fitted.residual
    power = float(left @ left)
    for name, shape in _shapes(fitted, drive, dt_ms):
        size = np.sqrt(np.sum(shape**2, axis=0))
        if np.all(size > 0.0) and power > 0.0:
            there = (shape / size)[fitted.known]
            free = fitted.unseen(there)
            weights = np.linalg.lstsq(free, left)[0]
            explained = power - float(np.sum((left - free @ weights) ** 2))
            chance = float(chi2.sf(explained / fitted.variance, len(weights)))
            yield Effect(name, explained / power, chance, -fitted.taken_up(there @ weights))


def _shapes(fitted: Fit, drive: Numbers, dt_ms: float) -> Iterator[tuple[str, Numbers]]:
    """Return the name of each effect and the residuals that it would leave, of any size.

    They are computed at all samples, because the device moves on while samples are lost.
    """
    x = fitted.motion
    v = np.gradient(x, dt_ms)
    yield "a drift of the offset", np.arange(len(x), dtype=np.float64)[:, None]
    yield "friction", fitted.pushed(np.sign(v), dt_ms)[:, None]
    yield "a nonlinear spring", fitted.pushed(x**3, dt_ms)[:, None]
    for part in (0.6, 0.75, 0.9):
        over = np.maximum(np.abs(x) - part * np.abs(x).max(), 0.0)
        yield "saturation of the displacement", (np.sign(x) * over)[:, None]
    slow = math.sqrt(fitted.stiffness)
    for ratio in (0.25, 0.5, 1.0, 2.0, 4.0):
        filtered = lfilter([1.0 - math.exp(-ratio * slow * dt_ms)], [1.0, -math.exp(-ratio * slow * dt_ms)], x)
        yield "a filter behind the motion, a model of higher order", np.asarray(filtered, np.float64)[:, None]
    drive = drive[SKIPPED : SKIPPED + len(x)]
    for ratio in MODES:
        stiffness = (ratio * slow) ** 2
        phi, push = transition(stiffness, 0.05 * ratio * slow, dt_ms)
        moved = response(phi, push, drive)
        # no difference to the next sample: in a loop it knows the noise of this one
        speed = np.diff(moved, prepend=0.0)
        yield f"a second mode near {ratio * slow / (2.0 * math.pi):.2g} kHz", np.stack([moved, speed], 1)
