"""A vector environment of Gymnasium: boards abreast, each driven by an action of its own."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from core.block import BoolArray, FloatArray, IntArray
from core.errors import InputError
from scenarios.outside.scope_picture import Picture
from scenarios.outside.tracking import RENDER_MODES, Observation, TaskOptions, TrackingTask
from scenarios.schema import Scenario

Steps = tuple[Observation, FloatArray, BoolArray, BoolArray, dict[str, Any]]


class TrackingVector(VectorEnv[Observation, NDArray[Any], NDArray[Any]]):
    """Boards abreast that follow the reference model of a scenario; each has the bits of `Tracking` with its seed.

    A seed of a reset is the seed of the first environment, the next ones follow it, or a list has all seeds; so does an
    option ``seed``. The option ``reset_mask`` names the environments to reset.

    Parameters
    ----------
    num_envs : int
        Environments.
    scenario, values, **options
        As for `scenarios.outside.environment.Tracking`.
    autoreset_mode : str or AutoresetMode
        ``NextStep``, ``SameStep`` or ``Disabled``, as Gymnasium has them.

    Raises
    ------
    InputError
        As `TrackingTask`; for an autoreset mode that there is not.
    """

    def __init__(
        self,
        num_envs: int = 1,
        scenario: str | Scenario = "first-look",
        values: dict[str, Any] | None = None,
        *,
        autoreset_mode: str | AutoresetMode = AutoresetMode.NEXT_STEP,
        **options: Any,
    ) -> None:
        try:
            self.autoreset_mode = AutoresetMode(autoreset_mode)
        except ValueError:
            known = ", ".join(mode.value for mode in AutoresetMode)
            raise InputError(f"must be one of {known}, got {autoreset_mode!r}", "autoreset_mode") from None
        self.task = TrackingTask(num_envs, TaskOptions(scenario, values, **options))
        self.num_envs, self.render_mode = num_envs, self.task.options.render_mode
        self.metadata = {
            "render_modes": [*RENDER_MODES],
            "render_fps": 30,
            "autoreset_mode": self.autoreset_mode,
        }
        self.single_action_space, self.single_observation_space = self.task.action_space, self.task.observation_space
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self._chances: list[np.random.Generator | None] = [None] * num_envs
        self._seen = np.zeros((num_envs, *self.single_observation_space.shape), dtype=np.float32)
        self._has_ended = np.zeros(num_envs, dtype=np.bool_)

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begin an episode in each environment, or in the environments of the mask.

        Raises
        ------
        InputError
            For seeds that are not as many as the environments, and for options that are not allowed.
        """
        given = dict(options or {})
        mask = given.pop("reset_mask", None)
        places = range(self.num_envs) if mask is None else np.flatnonzero(self._checked(mask)).tolist()
        seeds = [seed + i if isinstance(seed, int) else None for i in range(self.num_envs)]
        if seed is not None and not isinstance(seed, int):
            seeds = [*seed]
        if len(seeds) != self.num_envs:
            raise InputError(f"must be {self.num_envs} seeds, one for each environment, got {len(seeds)}", "seed")
        infos: dict[str, Any] = {}
        for place in places:
            own = {**given, "seed": given["seed"] + place} if isinstance(given.get("seed"), int) else given
            infos = self._add_info(infos, self._begin(place, seeds[place], own), place)
        return self._seen.copy(), infos

    def step(self, actions: NDArray[Any]) -> Steps:
        """Hold a voltage in each environment for the samples of a step.

        Raises
        ------
        InputError
            When an episode has ended and nothing has reset it.
        """
        ended = self._has_ended.copy()
        infos: dict[str, Any] = {}
        rewards, terminated, truncated = (np.zeros(self.num_envs, dtype=kind) for kind in (float, bool, bool))
        if ended.any():
            if self.autoreset_mode is AutoresetMode.DISABLED:
                text = f"environments {np.flatnonzero(ended).tolist()} have ended"
                raise InputError(text, "actions", "reset them by the option reset_mask")
            for place in np.flatnonzero(ended).tolist():
                infos = self._add_info(infos, self._begin(place, None, {}), place)
        going = np.flatnonzero(~ended)
        if len(going):
            outcome = self.task.step(going, np.asarray(actions).reshape(self.num_envs)[going])
            self._seen[going], rewards[going] = outcome.seen, outcome.rewards
            terminated[going], truncated[going] = outcome.terminated, outcome.truncated
            infos = self._told(infos, going)
        self._has_ended = terminated | truncated
        if self.autoreset_mode is AutoresetMode.SAME_STEP and self._has_ended.any():
            for place in np.flatnonzero(self._has_ended).tolist():
                final = {"final_obs": self._seen[place].copy(), "final_info": self.task.told_of(place)}
                infos = self._add_info(infos, final, place)
                infos = self._add_info(infos, self._begin(place, None, {}), place)
        return self._seen.copy(), rewards, terminated, truncated, infos

    def render(self) -> tuple[Picture, ...] | None:
        """Return a picture of each environment."""
        return tuple(map(self.task.draw, range(self.num_envs))) if self.render_mode else None

    def _begin(self, place: int, seed: int | None, options: dict[str, Any]) -> dict[str, Any]:
        chance = self._chances[place]
        if chance is None or seed is not None:
            chance = self._chances[place] = seeding.np_random(seed)[0]
        self._seen[place], self._has_ended[place] = self.task.begin(place, chance, options), False
        return {**self.task.told_of(place), **self.task.drawn(place)}

    def _told(self, infos: dict[str, Any], places: IntArray) -> dict[str, Any]:
        """Add infos as ``_add_info`` does it for one environment after another."""
        for name, values in self.task.told(places).items():
            if len(places) == self.num_envs:
                infos[name], infos[f"_{name}"] = values, np.ones(self.num_envs, dtype=np.bool_)
                continue
            shape = self.num_envs, *values.shape[1:]
            empty = np.full(shape, None, dtype=object) if values.dtype == object else np.zeros(shape, values.dtype)
            array, mask = infos.get(name, empty), infos.get(f"_{name}", np.zeros(self.num_envs, dtype=np.bool_))
            array[places], mask[places] = values, True
            infos[name], infos[f"_{name}"] = array, mask
        return infos

    def _checked(self, mask: object) -> BoolArray:
        is_mask = isinstance(mask, np.ndarray) and mask.shape == (self.num_envs,) and mask.dtype == np.bool_
        if not is_mask or not mask.any():  # type: ignore[attr-defined]
            raise InputError(f"must be {self.num_envs} booleans in an array, one of them true", "options.reset_mask")
        return mask  # type: ignore[return-value]
