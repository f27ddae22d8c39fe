"""The Gymnasium environment: its checker, its reward from the trace, the same bits as a law that does the same."""

from __future__ import annotations

import math
import warnings
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from core.errors import InputError
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.outside.environment import Tracking
from scenarios.run import run

SHORT = {"samples": 300}
MASS = {**SHORT, "events": [{"fault": "added_mass", "severity": 0.05, "at_sample": 100}]}


def play(env: Any, seed: int | None, law: Any = lambda seen: seen[0]) -> list[tuple[Any, ...]]:
    """Return every step of an episode: observation, reward, terminated, truncated, info."""
    seen, _ = env.reset(seed=seed)
    found: list[tuple[Any, ...]] = []
    while not found or not (found[-1][2] or found[-1][3]):
        found.append(env.step(np.array([law(seen)])))
        seen = found[-1][0]
    return found


def test_the_checker_has_nothing_to_say() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = gymnasium.make("CombBench/Tracking-v0", values=SHORT)
        check_env(env.unwrapped)


def test_an_episode_has_the_bits_of_a_run_with_the_same_law() -> None:
    """u = 16 r - 64 (y_m - y) of a limit of 32 V, an agent that is a law; the noise is that the episode names."""
    values = {**MASS, "drive.limit_v": 32.0, "reference.amplitude_v": 0.5}
    env = Tracking(values=values)
    steps = play(env, 7, lambda seen: 0.5 * seen[0] - 2.0 * (seen[1] - seen[2]))
    scenario = with_values(get("first-look"), values)
    trace = run(scenario, env.board.spec.seed, law=lambda x: 32.0 * (0.5 * x.reference - 2.0 * (x.model - x.measured)))
    assert len(steps) == 300 and steps[-1][3] and not steps[-1][2]
    assert env.board.digest() == trace.digest
    observed = np.array([seen for seen, *_ in steps[:-1]]).T
    for row, name in enumerate(("reference.voltage", "model.displacement", "sensor.displacement")):
        np.testing.assert_array_equal(observed[row], trace.signal(name)[1:])
    error = trace.signal("model.displacement")[1:] - trace.signal("plant.displacement")[1:]
    np.testing.assert_allclose([reward for _, reward, *_ in steps[:-1]], np.exp(-np.square(error)), rtol=1e-14)
    assert np.ptp(error) > 0.1


def test_the_seed_decides_this_episode_and_those_that_follow() -> None:
    def two_episodes(seed: int) -> list[str]:
        env = Tracking(values=SHORT)
        found = []
        for given in (seed, None):
            play(env, given)
            found.append(env.board.digest())
        return found

    first, again, other = two_episodes(3), two_episodes(3), two_episodes(4)
    assert first == again
    assert len({*first, *other}) == 4


def test_a_trip_ends_the_episode_without_a_reward() -> None:
    """Full voltage without a break: the guard trips once the drive has been at its limit for so long."""
    env = Tracking(values={**SHORT, "guard.rail_ms": 0.2, "drive.limit_v": 5.0})
    assert env.limit_v == 5.0
    steps = play(env, 1, lambda _: 1.2)
    seen, reward, terminated, truncated, info = steps[-1]
    assert terminated and not truncated and reward == 0.0 and info["trip"] == "the drive stayed at its limit"
    assert len(steps) == 21 and env.observation_space.contains(seen)
    assert all(math.isfinite(step[1]) and 0.0 <= step[1] <= 1.0 for step in steps)


def test_what_it_cannot_play_is_refused() -> None:
    with pytest.raises(InputError, match="study"):
        Tracking("ch1-table-1-1")
    with pytest.raises(InputError, match="options"):
        Tracking(values=SHORT).reset(options={"seed": 1})
