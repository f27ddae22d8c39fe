"""Rewards of an environment: between 0 and 1 at each tick, so that a trip, which ends an episode, never pays."""

from __future__ import annotations

from typing import NamedTuple

from core.errors import unknown


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
