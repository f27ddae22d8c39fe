"""A Gymnasium environment: an agent that drives a bench, sample by sample; importing this registers it."""

from __future__ import annotations

import math
from typing import Any

import gymnasium
import numpy as np
from gymnasium.spaces import Box

from core.block import FloatArray
from core.board.hosted import Hosted
from core.board.outside import Sample
from core.board.spec import MOST_SEED
from core.errors import InputError
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import DEFAULT_SAMPLES, build_hosted
from scenarios.schema import Scenario

FARTHEST = 1e6
"""Largest size of an observation, V or um: the board trips long before."""
OBSERVED = ("reference", "model", "measured", "applied")


class Tracking(gymnasium.Env[FloatArray, FloatArray]):
    r"""Follow the reference model of a scenario: ``CombBench/Tracking-v0``.

    An action is the voltage held over the next sample, as a share of the limit of the drive (-1 to 1); an observation
    has the inputs of a controller: reference (V), model (um), measured (um), voltage applied (V). The reward of a step,
    with the true displacement :math:`y` at its end, is

    .. math:: R=e^{-(y_m-y)^2/\sigma^2},\qquad \sigma=1\,\mu m

    so it is between 0 and 1, and a trip, which terminates the episode, costs all later rewards. The end of the scenario
    truncates it. The seed of a reset decides the noise of this episode and of all later episodes.

    Parameters
    ----------
    scenario : str or Scenario
        A library id, or a scenario; its events happen unchanged.
    values : dict, optional
        Fields of the scenario written over, by dotted paths.

    Raises
    ------
    InputError
        As `scenarios.run.build_hosted`, for another scenario than one of a single displacement.
    """

    metadata = {"render_modes": []}  # noqa: RUF012 (an attribute of the class that gymnasium declares)
    error_um = 1.0

    def __init__(self, scenario: str | Scenario = "first-look", values: dict[str, Any] | None = None) -> None:
        chosen = get(scenario) if isinstance(scenario, str) else scenario
        self.scenario = with_values(chosen, values or {})
        self._samples = self.scenario.samples or DEFAULT_SAMPLES
        self._voltage = 0.0
        self._board = build_hosted(self.scenario, law=self._answer)
        self.limit_v = self._board.spec.context().limit_v
        self.action_space = Box(-1.0, 1.0, (1,), np.float64)
        self.observation_space = Box(-FARTHEST, FARTHEST, (len(OBSERVED),), np.float64)

    @property
    def board(self) -> Hosted:
        """The board of this episode, for inspection; an agent that learns from it cheats."""
        return self._board

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[FloatArray, dict[str, Any]]:
        """Begin an episode, with noise of its own."""
        super().reset(seed=seed)
        if options:
            raise InputError("an episode has no options", "options", "give the environment other values")
        noise = int(self.np_random.integers(MOST_SEED))
        self._board = build_hosted(self.scenario, noise, law=self._answer)
        sample = self._board.sample()
        assert sample is not None
        return _observation(sample), self._info()

    def step(self, action: FloatArray) -> tuple[FloatArray, float, bool, bool, dict[str, Any]]:
        """Hold a voltage until the next sample."""
        self._voltage = self.limit_v * float(np.asarray(action).item())
        self._board.advance(1)
        sample = self._board.sample()
        if sample is None:
            return self._last, 0.0, True, False, self._info()
        error = self._board.value("model.displacement") - self._board.value("plant.displacement")
        reward = math.exp(-((error / self.error_um) ** 2))
        return _observation(sample), reward, False, self._board.tick >= self._samples, self._info()

    def _answer(self, sample: Sample) -> float:
        self._last = _observation(sample)
        return self._voltage

    def _info(self) -> dict[str, Any]:
        """Return where the episode is, and why it ended if it did."""
        board = self._board
        trip = "" if board.trip is None else board.trip.reason
        return {"tick": board.tick, "time_ms": board.tick * board.dt_ms, "seed": board.spec.seed, "trip": trip}


def _observation(sample: Sample) -> FloatArray:
    """Return the observation, within the space."""
    seen = np.array([getattr(sample, name) for name in OBSERVED])
    within: FloatArray = np.clip(np.nan_to_num(seen), -FARTHEST, FARTHEST)
    return within


gymnasium.register("CombBench/Tracking-v0", f"{__name__}:Tracking")
