"""Steps of the environments of Gymnasium: boards abreast, one board, and the pendulum of Gymnasium in the same run."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from scenarios.speed.timing import cpu_ns

COUNT, STEPS, SKIP = 256, 30, 10
ID = "scenarios.outside.environment:CombBench/Tracking-v1"
VALUES: dict[str, Any] = {"diagnosers": {}}


def one_cost(steps: int = 1000) -> Callable[[], float]:
    """Return the measurement of a step of the single environment, ns."""
    return _single(ID, steps, values=VALUES)


def pendulum_cost(steps: int = 2000) -> Callable[[], float]:
    """Return the measurement of a step of Gymnasium's pendulum, ns."""
    return _single("Pendulum-v1", steps)


def _single(name: str, steps: int, **options: Any) -> Callable[[], float]:
    import gymnasium

    env = gymnasium.make(name, **options)
    env.reset(seed=1)
    actions = np.random.default_rng(1).uniform(-0.1, 0.1, (steps, 1)).astype(np.float32)

    def work() -> None:
        for action in actions:
            *_, terminated, truncated, _ = env.step(action)
            if terminated or truncated:
                env.reset()

    return lambda: cpu_ns(work, steps)


def abreast_cost(frame_skip: int, count: int = COUNT, steps: int = STEPS) -> Callable[[], float]:
    """Return the measurement of a step of one of many environments abreast, ns."""
    import gymnasium

    mode = "vector_entry_point"
    envs = gymnasium.make_vec(
        ID,
        num_envs=count,
        vectorization_mode=mode,
        values=VALUES,
        frame_skip=frame_skip,
    )
    envs.reset(seed=1)
    actions = np.random.default_rng(1).uniform(-0.1, 0.1, (steps, count, 1)).astype(np.float32)

    def work() -> None:
        for action in actions:
            envs.step(action)

    return lambda: cpu_ns(work, steps * count)
