"""Gymnasium environments: agents that drive a bench, or many; importing this registers them."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from core.board.lane import Lane
from scenarios.outside.scope_picture import Picture
from scenarios.outside.tracking import FIRST, RENDER_MODES, Observation, TaskOptions, TrackingTask
from scenarios.schema import Scenario

ID = "CombBench/Tracking-v1"


class Tracking(gymnasium.Env[Observation, NDArray[Any]]):
    """Follow the reference model of a scenario: ``CombBench/Tracking-v1``.

    The seed of a reset decides the noise, and the values and faults that chance draws, of this episode and of all later
    episodes. An option ``seed`` of a reset is the seed of the noise itself, ``values`` are fields of the bench, both of
    this episode alone.

    Parameters
    ----------
    scenario : str or Scenario
        A library id, or a scenario.
    values : dict, optional
        Fields of the scenario written over, by dotted paths.
    **options
        See `scenarios.outside.tracking.TrackingTask`, which also has the observations and the rewards.

    Raises
    ------
    InputError
        As `TrackingTask`.
    """

    metadata = {"render_modes": [*RENDER_MODES], "render_fps": 30}  # noqa: RUF012 (declared so by gymnasium)

    def __init__(
        self, scenario: str | Scenario = "first-look", values: dict[str, Any] | None = None, **options: Any
    ) -> None:
        self.task = TrackingTask(1, TaskOptions(scenario, values, **options))
        self.scenario, self.limit_v = self.task.scenario, self.task.limit_v
        self.action_space, self.observation_space = self.task.action_space, self.task.observation_space
        self.render_mode = self.task.options.render_mode

    @property
    def board(self) -> Lane:
        """The board of this episode, for inspection; an agent that learns from it cheats."""
        return self.task.boards[0]

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begin an episode, with noise of its own."""
        super().reset(seed=seed)
        seen = self.task.begin(0, self.np_random, options or {})
        return seen, {**self.task.told_of(0), **self.task.drawn(0)}

    def step(self, action: NDArray[Any]) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Hold a voltage for the samples of a step."""
        seen, rewards, terminated, truncated = self.task.step(FIRST, np.asarray(action).reshape(1))
        return seen[0], float(rewards[0]), bool(terminated[0]), bool(truncated[0]), self.task.told_of(0)

    def render(self) -> Picture | None:
        """Return the last samples as a picture."""
        return self.task.draw(0) if self.render_mode else None


gymnasium.register(ID, f"{__name__}:Tracking", vector_entry_point="scenarios.outside.vector_environment:TrackingVector")
