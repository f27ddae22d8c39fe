"""Which moment of the board is shown: true motion when it is slow enough to see, a strobe when it is not."""

from __future__ import annotations

from dataclasses import dataclass

SEEN_HZ = 8.0
"""An oscillation faster than this on the screen is strobed."""

STROBE_HZ = 0.8
"""What a strobed oscillation looks like."""

EXAGGERATIONS = (1.0, 2.0, 3.0, 4.0, 5.0, 8.0, 10.0, 20.0, 50.0, 100.0)
WANTED_UM = 16.0
"""Amplitude that is well seen at the size of the device, and that its fingers have room for."""


@dataclass(frozen=True)
class Moment:
    """A tick to show, and whether it was chosen by the strobe."""

    tick: int
    is_strobed: bool


def moment(head: int, period_ticks: float | None, rate_ticks_s: float, wall_s: float) -> Moment:
    """Choose the tick to show.

    Parameters
    ----------
    head : int
        First tick not computed yet.
    period_ticks : float or None
        Period of the drive, if it has one.
    rate_ticks_s : float
        Ticks per wall second.
    wall_s : float
        Wall clock: where the strobe is in its slow cycle.
    """
    last = head - 1
    if period_ticks is None or rate_ticks_s <= SEEN_HZ * period_ticks:
        return Moment(last, False)
    phase = (wall_s * STROBE_HZ) % 1.0
    behind = (last / period_ticks - phase) % 1.0
    return Moment(max(0, last - round(behind * period_ticks)), True)


def exaggeration(amplitude_um: float, now: float) -> float:
    """Choose a round factor that makes the motion visible; keep the present one while it does.

    Parameters
    ----------
    amplitude_um : float
        Largest recent displacement.
    now : float
        The present factor.
    """
    if amplitude_um <= 0.0 or 0.4 * WANTED_UM <= amplitude_um * now <= 1.2 * WANTED_UM:
        return now
    fitting = [factor for factor in EXAGGERATIONS if amplitude_um * factor <= WANTED_UM]
    return fitting[-1] if fitting else 1.0


def caption(factor: float, is_strobed: bool) -> str:
    """Say what is not as in nature."""
    parts = [f"motion × {factor:g}" if factor != 1.0 else "true scale"]
    if is_strobed:
        parts.append("strobe")
    return ", ".join(parts)
