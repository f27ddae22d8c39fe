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
from scenarios.outside.environment import ID, Tracking
from scenarios.outside.rewards import Reward
from scenarios.run import run

SHORT = {"samples": 300}
MASS = {**SHORT, "events": [{"fault": "added_mass", "severity": 0.05, "at_sample": 100}]}
DRAWS = {"sensor.noise_um": (0.0, 0.2), "device.mass_kg": (1.9e-9, 2.3e-9)}
FAULTS = {"added_mass": (0.02, 0.1), "stiffness": (-0.1, 0.1)}


def play(env: Any, seed: int | None, law: Any = lambda seen: seen[0], **options: Any) -> list[tuple[Any, ...]]:
    """Return every step of an episode: observation, reward, terminated, truncated, info."""
    seen, _ = env.reset(seed=seed, options=options)
    found: list[tuple[Any, ...]] = []
    while not found or not (found[-1][2] or found[-1][3]):
        found.append(env.step(np.array([law(seen)], dtype=np.float32)))
        seen = found[-1][0]
    return found


def test_the_checker_has_nothing_to_say() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = gymnasium.make(ID, values=SHORT, render_mode="rgb_array")
        check_env(env.unwrapped)


@pytest.mark.parametrize("skip", [1, 4])
def test_an_episode_has_the_bits_of_a_run_with_the_same_law(skip: int) -> None:
    """u = 16 r - 64 (y_m - y) of a limit of 32 V, an agent that is a law; the noise is that the episode names."""
    values = {**MASS, "drive.limit_v": 32.0, "reference.amplitude_v": 0.5}
    env = Tracking(values=values, frame_skip=skip)
    asked: list[float] = []

    def agent(seen: Any) -> float:
        asked.append(float(np.float32(0.5 * seen[0] - 0.2 * seen[3])))
        return asked[-1]

    steps = play(env, 7, agent)
    scenario = with_values(get("first-look"), values)
    trace = run(scenario, env.board.spec.seed, law=lambda x: 32.0 * asked[x.tick // skip])
    assert len(steps) == 300 // skip and steps[-1][3] and not steps[-1][2]
    assert env.board.digest() == trace.digest
    observed = np.array([seen for seen, *_ in steps[:-1]]).T
    scale = env.task.scale_um
    signals = ("reference.voltage", 32.0), ("model.displacement", scale), ("sensor.displacement", scale)
    for row, (name, unit) in enumerate(signals):
        np.testing.assert_allclose(observed[row], trace.signal(name)[skip::skip] / unit, rtol=2e-7)
    np.testing.assert_allclose(observed[3], observed[1] - observed[2], atol=3e-7)
    error = trace.signal("model.displacement")[1:] - trace.signal("plant.displacement")[1:]
    expected = np.exp(-np.square(error))[: len(error) // skip * skip].reshape(-1, skip).mean(axis=1)
    np.testing.assert_allclose([reward for _, reward, *_ in steps[: len(expected)]], expected, rtol=1e-13)
    assert np.ptp(error) > 0.1


def test_the_weights_of_a_reward() -> None:
    """R = exp(-(e/s)^2 - a (u/L)^2 - b (du/L)^2), from the trace."""
    env = Tracking(values=SHORT, reward=Reward(0.5, 0.3, 2.0))
    asked = [float(np.float32(0.3 * math.sin(0.05 * k))) for k in range(300)]
    voltages = iter(asked)
    steps = play(env, 2, lambda _: next(voltages))
    trace = run(env.scenario, env.board.spec.seed, law=lambda x: env.limit_v * asked[x.tick])
    error = (trace.signal("model.displacement") - trace.signal("plant.displacement"))[1:]
    used = trace.signal("drive.voltage")[:-1] / env.limit_v
    moved = np.diff(used, prepend=0.0)
    expected = np.exp(-np.square(error / 0.5) - 0.3 * np.square(used) - 2.0 * np.square(moved))
    np.testing.assert_allclose([reward for _, reward, *_ in steps[:-1]], expected, rtol=1e-12)


def test_the_seed_decides_this_episode_and_those_that_follow() -> None:
    def two_episodes(seed: int) -> list[str]:
        env = Tracking(values=SHORT, draws=DRAWS, faults=FAULTS)
        found = []
        for given in (seed, None):
            play(env, given)
            found.append(env.board.digest())
        return found

    first, again, other = two_episodes(3), two_episodes(3), two_episodes(4)
    assert first == again
    assert len({*first, *other}) == 4


def test_an_episode_has_the_bits_of_a_run_with_the_values_and_the_fault_that_it_names() -> None:
    env = Tracking(values=SHORT, draws=DRAWS, faults=FAULTS)
    named = set()
    for seed in range(8):
        _, info = env.reset(seed=seed)
        steps = play(env, seed)
        events = [(entry, command) for entry, command in env.board.done]
        assert [command.fault for _, command in events] == ([info["fault"]] if info["fault"] else [])
        event = [{"fault": c.fault, "severity": c.severity, "at_sample": tick} for tick, c in events]
        scenario = with_values(get("first-look"), {**SHORT, **info["values"], "events": event})
        result = run(scenario, info["seed"], law=lambda x: env.limit_v * float(np.float32(x.reference / env.limit_v)))
        assert result.digest == env.board.digest() and len(steps) == 300
        assert all(low <= info["values"][path] <= high for path, (low, high) in DRAWS.items())
        named.add(info["fault"])
    assert named == {"", *FAULTS}


def test_options_of_a_reset_are_for_one_episode() -> None:
    env = Tracking(values=SHORT)
    _, info = env.reset(seed=1, options={"seed": 77, "values": {"sensor.noise_um": 0.0}})
    assert info["seed"] == env.board.spec.seed == 77 and info["values"] == {"sensor.noise_um": 0.0}
    _, after = env.reset()
    assert after["values"] == {} and after["seed"] != 77
    _, first = env.reset(seed=1)
    _, second = env.reset()
    assert second["seed"] == after["seed"] != first["seed"]
    for options, word in (
        ({"sed": 1}, "option"),
        ({"seed": -1}, "options.seed"),
        ({"seed": 0.5}, "options.seed"),
        ({"values": {"plant.model": "nonlinear"}}, "options.values"),
        ({"values": {"sensor.nois_um": 1.0}}, "sensor.nois_um"),
    ):
        with pytest.raises(InputError, match=word):
            env.reset(options=options)


def test_a_trip_ends_the_episode_without_a_reward() -> None:
    """Full voltage without a break: the guard trips once the drive has been at its limit for so long."""
    env = Tracking(values={**SHORT, "guard.rail_ms": 0.2, "drive.limit_v": 5.0})
    assert env.limit_v == 5.0
    steps = play(env, 1, lambda _: 1.2)
    seen, reward, terminated, truncated, info = steps[-1]
    assert terminated and not truncated and reward == 0.0 and info["trip"] == "the drive stayed at its limit"
    assert len(steps) == 21 and env.observation_space.contains(seen)
    assert all(math.isfinite(step[1]) and 0.0 <= step[1] <= 1.0 for step in steps)


@pytest.mark.parametrize("on_violation", ["nothing", "penalty", "end"])
def test_a_constraint_is_told_and_may_cost_or_end(on_violation: str) -> None:
    bounds = {"plant.displacement": (-0.4, 0.4), "drive.voltage": (-30.0, 30.0)}
    env = Tracking(values=SHORT, frame_skip=5, constraints=bounds, on_violation=on_violation, penalty=0.25)
    plain = Tracking(values=SHORT, frame_skip=5)
    steps, others = play(env, 5), play(plain, 5)
    values = np.array([info["constraint_values"] for *_, info in steps])
    violated = (values > 0.0).any(axis=1)
    assert violated.any() and not violated.all() and (values[:, 1] <= 0.0).all()
    assert [info["constraint_violation"] for *_, info in steps] == violated.tolist()
    if on_violation == "end":
        assert steps[-1][2] and violated.sum() == 1 and violated[-1]
    else:
        cost = 0.25 * violated if on_violation == "penalty" else 0.0
        np.testing.assert_array_equal([s[1] for s in steps], np.array([s[1] for s in others]) - cost)


def test_the_picture_shows_the_last_samples() -> None:
    env = Tracking(values=SHORT, render_mode="rgb_array")
    env.reset(seed=1)
    empty = env.render()
    assert empty is not None and empty.shape == (320, 480, 3) and empty.dtype == np.uint8
    for _ in range(50):
        env.step(np.array([0.5], dtype=np.float32))
    picture = env.render()
    assert picture is not None
    changed = (picture != empty).any(axis=2)
    assert changed[:, :50].any(axis=0).all() and not changed[:, 50:].any()
    voltage = np.argwhere((picture == (180, 80, 0)).all(axis=2))
    assert {int(row) for row, column in voltage if column > 1} == {232 + round(0.25 * (312 - 232))}
    env.reset(seed=1)
    np.testing.assert_array_equal(env.render(), empty)


def test_an_episode_may_be_shorter_than_the_scenario() -> None:
    env = Tracking(values=SHORT, frame_skip=10, max_episode_steps=7)
    steps = play(env, 1)
    assert len(steps) == 7 and steps[-1][3] and steps[-1][4]["tick"] == 70


def test_what_it_cannot_play_is_refused() -> None:
    for options, word in (
        ({"scenario": "ch1-table-1-1"}, "study"),
        ({"scenario": "first-look", "values": {"device.id": "gyro-a"}}, "axes|controller|model|gyro"),
        ({"frame_skip": 0}, "frame_skip"),
        ({"max_episode_steps": 0}, "max_episode_steps"),
        ({"reward": "best"}, "reward"),
        ({"draws": {"sensor.noise_um": (0.2, 0.1)}}, "draws.sensor.noise_um"),
        ({"draws": {"sensor.noise": (0.1, 0.2)}}, "sensor.noise"),
        ({"faults": {"added_mas": (0.1, 0.2)}}, "added_mas"),
        ({"constraints": {"plant.displacment": (0.1, 0.2)}}, "constraints"),
        ({"constraints": {"plant.displacement": (0.1, 0.2)}, "on_violation": "stop"}, "on_violation"),
        ({"render_mode": "human"}, "render_mode"),
        (
            {"values": {"events": [{"fault": "added_mass", "severity": 0.1, "when": "plant.displacement > 1"}]}},
            "events",
        ),
    ):
        with pytest.raises(InputError, match=word):
            Tracking(**options)
