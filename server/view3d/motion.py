"""The moment of the board that is shown: true motion if it is slow enough to see, a strobe otherwise."""

from __future__ import annotations

import math

from core.format import format_short
from server.view3d.resonator.layout import HEIGHTS, WIDTHS

SEEN_HZ = 8.0
"""An oscillation faster than this on the screen is strobed."""

STROBE_HZ = 0.8
"""Frequency at which a strobed oscillation appears."""

EXAGGERATIONS = (1.0, 2.0, 3.0, 4.0, 5.0, 8.0, 10.0, 20.0, 50.0, 100.0)
TURN_EXAGGERATIONS = (1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0)
WANTED_UM = 16.0
"""Amplitude that is well seen at the size of the device, and that its fingers have room for."""
WANTED_TURN_UM = 12.0
"""The same for the motion of the ends of the arms by a rotation."""


def moment(head: int, period_ticks: float | None, rate_ticks_s: float, wall_s: float) -> tuple[int, bool]:
    """Choose the tick to show; return it, and whether the strobe has chosen it.

    Parameters
    ----------
    head : int
        First tick not computed yet.
    period_ticks : float or None
        Period of the drive, if it has one.
    rate_ticks_s : float
        Ticks per wall second.
    wall_s : float
        Wall clock; it sets the place of the strobe in its slow cycle.
    """
    last = head - 1
    if period_ticks is None or rate_ticks_s <= SEEN_HZ * period_ticks:
        return last, False
    phase = (wall_s * STROBE_HZ) % 1.0
    behind = (last / period_ticks - phase) % 1.0
    return max(0, last - round(behind * period_ticks)), True


def exaggeration(
    amplitude_um: float, now: float, wanted_um: float = WANTED_UM, factors: tuple[float, ...] = EXAGGERATIONS
) -> float:
    """Choose a round factor that makes the motion visible; keep the present one while it does.

    Parameters
    ----------
    amplitude_um : float
        Largest recent displacement.
    now : float
        The present factor.
    wanted_um : float
        Amplitude that is well seen.
    factors : tuple of float
        The round factors, rising.
    """
    if amplitude_um <= 0.0 or 0.4 * wanted_um <= amplitude_um * now <= 1.2 * wanted_um:
        return now
    fitting = [factor for factor in factors if amplitude_um * factor <= wanted_um]
    return fitting[-1] if fitting else 1.0


def warning(lateral_um: float, gap_um: float) -> float:
    """Return how much of the colour of attention a comb takes: nothing at the centre of its gap, all at the stator.

    It is the root of the closed share of the gap, so that the approach is visible: stability is lost when a tenth to a
    fifth has closed.
    """
    return math.sqrt(min(1.0, abs(lateral_um) / gap_um))


def caption(factor: float, turn_factor: float | None, is_strobed: bool) -> str:
    """Return in words how the picture differs from the true motion.

    Parameters
    ----------
    factor, turn_factor : float
        Exaggeration of the motion along x and of the rotation; none where the plant has no rotation.
    is_strobed : bool
        Whether the motion shown is slower than the true one.
    """
    parts = [f"motion × {format_short(factor, '', 3)}"]
    if turn_factor is not None:
        parts += [f"rotation × {format_short(turn_factor, '', 3)}", "gaps × 1"]
    parts.append(f"heights × {format_short(HEIGHTS, '')}, beam widths × {format_short(WIDTHS, '')}")
    if is_strobed:
        parts.append("strobe")
    return ", ".join(parts).replace("× ", "×\u00a0")  # no line break parts them
