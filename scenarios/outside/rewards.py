"""Rewards of an environment: between 0 and 1 at each tick, so that a trip, which ends an episode, never pays."""

from __future__ import annotations

from typing import NamedTuple

from core.block import FloatArray, IntArray
from core.elementary import exp
from core.errors import unknown
from core.kernel import kernel


class Reward(NamedTuple):
    r"""Weights of a reward, :math:`R=e^{-J}`, the mean over the ticks of a step.

    .. math:: J=\frac{(y_m-y)^2}{\sigma^2}+\rho\,\frac{u^2}{u_{max}^2}+\kappa\,\frac{(\Delta u)^2}{u_{max}^2}

    Parameters
    ----------
    error_um : float
        :math:`\sigma`, of the model displacement minus the true displacement.
    effort, change : float
        :math:`\rho` and :math:`\kappa`, of the voltage applied and of its change from tick to tick, over the limit.
    """

    error_um: float = 1.0
    effort: float = 0.0
    change: float = 0.0


PRESETS = {
    "tracking": Reward(),
    "precise": Reward(error_um=0.1),
    "effort": Reward(effort=1.0),
    "smooth": Reward(change=100.0),
}
"""Rewards by name."""


def reward_of(given: str | Reward) -> Reward:
    """Return a reward by its name, or the reward itself.

    Raises
    ------
    InputError
        For a name that there is not.
    """
    if isinstance(given, Reward):
        return given
    if given not in PRESETS:
        raise unknown("reward", given, PRESETS, "reward")
    return PRESETS[given]


@kernel
def rewarded(
    rows: FloatArray,
    counts: IntArray,
    before: FloatArray,
    error_um: float,
    effort: float,
    change: float,
    limit_v: float,
    rewards: FloatArray,
) -> None:
    """Write the rewards of a step.

    Parameters
    ----------
    rows : ndarray, shape (ticks, signals, boards)
        Model displacement, true displacement and applied voltage at each tick, in this order.
    counts : ndarray, shape (boards,)
        The ticks of each; the others have no reward.
    before : ndarray, shape (boards,)
        The voltage applied before, replaced by the last one.
    error_um, effort, change, limit_v : float
        The weights, and the limit of the drive.
    rewards : ndarray, shape (boards,)
        Receives the rewards.
    """
    for k in range(rows.shape[2]):
        total, last = 0.0, before[k]
        for i in range(counts[k]):
            error, voltage = (rows[i, 0, k] - rows[i, 1, k]) / error_um, rows[i, 2, k]
            used, moved = voltage / limit_v, (voltage - last) / limit_v
            total += exp(-(error * error + effort * used * used + change * moved * moved))
            last = voltage
        before[k] = last
        rewards[k] = total / rows.shape[0]
