"""Reasons against a mass, a damper and a spring: each check looks for one of them and has a sentence for it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from scenarios.records.columns import Numbers
from scenarios.records.effects import effects
from scenarios.records.fit import Fit
from scenarios.records.remainder import Remainder

CLIPPED = 0.005
"""Share of samples at an extreme value for which a converter counts as clipped."""
GROWN = 1.3
"""Largest standard deviation on the half that was not fitted, over the other half."""
ALIKE = 0.2
"""Largest correlation of a residual with an earlier one."""
LAGS = 40
FEWEST_PAIRS = 0.2
"""Share of the pairs of samples at a lag that must be known for a correlation."""
STEEP = 4.5
"""Standard errors beyond which a correlation is none of chance."""
DRIFT = 0.1
"""Largest change of the delay between the halves, in samples."""
NEGLIGIBLE = 1e-6
"""Residual over the range of the displacement that is no reason, whatever it looks like."""
NAMED = 0.3
"""Share of the residual's power that an effect must explain to be named as the reason."""


@dataclass(frozen=True)
class Check:
    """A figure, its limit, whether it holds, and the sentence where it does not."""

    name: str
    value: float
    limit: float
    ok: bool
    sentence: str = ""


@dataclass
class Halves:
    """The fit on the first half of a stretch, and its remainder on the second."""

    fitted: Fit
    later: Remainder
    drive: Numbers = field(repr=False)
    displacement: Numbers = field(repr=False)
    dt_ms: float

    @cached_property
    def quantum(self) -> float:
        """Step of the converter, um; 0 where none is seen."""
        values = np.unique(self.displacement[np.isfinite(self.displacement)])
        if len(values) < 2:
            return 0.0
        steps = np.diff(values)
        least = float(steps[steps > 1e-9 * np.ptp(values)].min())
        off = np.abs(steps / least - np.rint(steps / least))
        known = int(np.isfinite(self.displacement).sum())
        return least if np.mean(off < 0.02) > 0.98 and len(values) < 0.9 * known else 0.0

    @property
    def later_known(self) -> NDArray[np.bool_]:
        """Which samples of the second half were measured."""
        return np.isfinite(self.displacement[len(self.displacement) // 2 :])

    @property
    def rounding(self) -> float:
        """Standard deviation of the rounding, um: no model can do better."""
        return self.quantum / math.sqrt(12.0)

    @property
    def negligible(self) -> float:
        """Standard deviation of a residual that is no reason, um."""
        return NEGLIGIBLE * float(np.nanmax(self.displacement) - np.nanmin(self.displacement))

    @cached_property
    def reason(self) -> str:
        """The effect that explains most of a residual that is no noise, in words; empty if it explains little."""
        found = ((one.share, one.name) for one in effects(self.fitted, self.drive, self.dt_ms))
        share, name = max(found, default=(0.0, ""))
        if share < NAMED:
            return ""
        return f"{name} explains {100.0 * share:.0f} % of the motion that mass, damper and spring leave unexplained"


def clipping(halves: Halves) -> Check:
    """Look for samples that stay at an extreme value."""
    y = halves.displacement[np.isfinite(halves.displacement)]
    at = [float(np.mean(y == extreme)) for extreme in (y.min(), y.max())]
    runs = max(_longest(halves.displacement == extreme) for extreme in (y.min(), y.max()))
    still = max(at) > CLIPPED and runs > 3 and not _is_resting(halves)
    side = y.max() if at[1] >= at[0] else y.min()
    return Check(
        "clipped", max(at), CLIPPED, not still, f"the displacement is clipped at {side:.4g} um" if still else ""
    )


def _longest(marks: np.ndarray) -> int:
    """Return the length of the longest stretch of marks."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], marks.astype(np.int8), [0]))))
    return int((edges[1::2] - edges[::2]).max()) if len(edges) else 0


def _is_resting(halves: Halves) -> bool:
    """Whether the motion is no larger than a few steps of the converter."""
    return (
        halves.quantum > 0.0
        and float(np.nanmax(halves.displacement) - np.nanmin(halves.displacement)) < 8 * halves.quantum
    )


def growth(halves: Halves) -> Check:
    """Compare the residual of the half that was not fitted with the other half."""
    floor = max(halves.fitted.noise, halves.rounding, halves.negligible)
    ratio = halves.later.size / floor if floor > 0.0 else math.inf
    ok = ratio <= GROWN
    return Check(
        "residual_ratio", ratio, GROWN, ok, "" if ok else _because(halves, f"its error grows {ratio:.1f} times")
    )


def whiteness(halves: Halves) -> Check:
    """Look for correlation of the residuals, beyond chance and beyond the rounding of the converter."""
    fitted, later = halves.fitted, halves.later_known
    worst = max(_correlation(fitted.residual, fitted.known), _correlation(halves.later.residual, later))
    limit = max(ALIKE, STEEP / math.sqrt(len(halves.later.residual) * later.mean()))  # by how many pairs are known
    is_small = halves.fitted.noise <= max(1.1 * halves.rounding, halves.negligible)
    ok = worst <= limit or is_small
    return Check("correlation", worst, limit, ok, "" if ok else _because(halves, "its errors follow each other"))


def _correlation(residual: Numbers, known: NDArray[np.bool_]) -> float:
    """Return the largest correlation of the residual with an earlier one, by the pairs of known samples."""
    e = np.zeros(len(known))
    e[known] = residual - residual.mean()
    power = float(e @ e)
    if power == 0.0:
        return 0.0
    found = [0.0]
    for lag in range(1, min(LAGS, len(e) // 4)):
        pairs = float(np.mean(known[lag:] & known[:-lag]))
        if pairs >= FEWEST_PAIRS:
            found.append(abs(float(e[lag:] @ e[:-lag])) / power * float(known.mean()) / pairs)
    return max(found)


def drift(halves: Halves) -> Check:
    """Look for a delay on the half that was not fitted which is another than on the fitted half."""
    change, limit = abs(halves.later.missed_delay), max(DRIFT, STEEP * halves.later.delay_error)
    ok = change <= limit
    sentence = "" if ok else f"the delay drifts by {change:.1f} samples in this stretch"
    return Check("delay_change", change, limit, ok, sentence)


def _because(halves: Halves, found: str) -> str:
    """Return the sentence for a residual that is no noise: its reason, or else the finding."""
    return halves.reason or f"a mass, a damper and a spring do not explain the motion: {found}"


CHECKS: tuple[Callable[[Halves], Check], ...] = (clipping, drift, growth, whiteness)
