"""The vector environment: each of its environments is the single one with its seed, bit for bit, in every mode."""

from __future__ import annotations

import warnings
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode, SyncVectorEnv

from core.errors import InputError
from scenarios.outside.environment import ID, Tracking
from scenarios.outside.vector_environment import TrackingVector

OPTIONS: dict[str, Any] = {
    "values": {"samples": 120, "diagnosers": {}, "guard.travel_um": 1.8},
    "frame_skip": 7,
    "draws": {"sensor.noise_um": (0.0, 0.1)},
    "faults": {"added_mass": (0.02, 0.1), "debris": (0.2, 0.8)},
    "constraints": {"plant.displacement": (-0.5, 0.5)},
    "on_violation": "penalty",
}
COUNT = 11
TOLD = ("tick", "time_ms", "trip", "seed", "fault", "severity", "constraint_values", "constraint_violation")


def pair(mode: str) -> tuple[Any, Any]:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        abreast = gymnasium.make_vec(
            ID, num_envs=COUNT, vectorization_mode="vector_entry_point", autoreset_mode=mode, **OPTIONS
        )
    return abreast, SyncVectorEnv([lambda: Tracking(**OPTIONS)] * COUNT, autoreset_mode=mode)


def same(one: dict[str, Any], other: dict[str, Any]) -> None:
    assert one.keys() == other.keys()
    for name in TOLD:
        if name in one:
            np.testing.assert_array_equal(one[name], other[name])
            np.testing.assert_array_equal(one[f"_{name}"], other[f"_{name}"])


@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
def test_it_steps_as_the_environments_of_gymnasium_side_by_side(mode: str) -> None:
    abreast, apart = pair(mode)
    assert abreast.metadata["autoreset_mode"] is AutoresetMode(mode)
    for name in ("observation_space", "action_space", "single_observation_space", "single_action_space"):
        assert getattr(abreast, name) == getattr(apart, name)
    chance = np.random.default_rng(1)
    (seen, infos), (other, others) = abreast.reset(seed=3), apart.reset(seed=3)
    np.testing.assert_array_equal(seen, other)
    same(infos, others)
    ended = np.zeros(2, dtype=int)
    for number in range(45):
        actions = np.clip(chance.normal(scale=0.15, size=(COUNT, 1)), -1.0, 1.0).astype(np.float32)
        actions[:3] += 0.12 * (number % 9)
        *found, infos = abreast.step(actions)
        *expected, others = apart.step(actions)
        for one, another in zip(found, expected, strict=True):
            np.testing.assert_array_equal(one, another)
        same(infos, others)
        if "final_obs" in infos:
            for place in np.flatnonzero(infos["_final_obs"]):
                np.testing.assert_array_equal(infos["final_obs"][place], others["final_obs"][place])
            same(infos["final_info"], others["final_info"])
        ended += [found[2].sum(), found[3].sum()]
    assert (ended > 5).all()
    assert [a.digest() for a in abreast.task.boards] == [env.board.digest() for env in apart.envs]


def test_environments_that_ended_wait_for_a_mask_when_nothing_resets_them() -> None:
    env = TrackingVector(3, autoreset_mode="Disabled", **{**OPTIONS, "max_episode_steps": 2})
    env.reset(seed=[5, 6, 7])
    actions = np.zeros((3, 1), dtype=np.float32)
    env.step(actions)
    *_, truncated, _ = env.step(actions)
    assert truncated.all()
    with pytest.raises(InputError, match=r"environments \[0, 1, 2\] have ended"):
        env.step(actions)
    _, infos = env.reset(seed=[1, 2, 3], options={"reset_mask": np.array([True, False, True])})
    assert infos["_seed"].tolist() == [True, False, True]
    with pytest.raises(InputError, match=r"environments \[1\] have ended"):
        env.step(actions)
    env.reset(options={"reset_mask": np.array([False, True, False])})
    seen, *_ = env.step(actions)
    single = Tracking(**OPTIONS)
    single.reset(seed=3)
    np.testing.assert_array_equal(seen[2], single.step(actions[0])[0])


def test_a_seed_of_the_noise_counts_up_too() -> None:
    env = TrackingVector(3, **OPTIONS)
    _, infos = env.reset(options={"seed": 40, "values": {"sensor.noise_um": 0.0}})
    assert infos["seed"].tolist() == [40, 41, 42] and infos["values"]["sensor.noise_um"].tolist() == [0.0] * 3


def test_pictures_of_all_environments() -> None:
    env = TrackingVector(3, render_mode="rgb_array", **OPTIONS)
    env.reset(seed=1)
    env.step(np.array([[0.1], [0.2], [0.3]], dtype=np.float32))
    pictures = env.render()
    assert pictures is not None and len(pictures) == 3
    assert not np.array_equal(pictures[0], pictures[1])


def test_what_it_cannot_do_is_refused() -> None:
    with pytest.raises(InputError, match="autoreset_mode"):
        TrackingVector(2, autoreset_mode="Never")
    env = TrackingVector(2, **OPTIONS)
    with pytest.raises(InputError, match="2 seeds"):
        env.reset(seed=[1])
    for mask in (np.array([True]), np.array([False, False]), [True, False]):
        with pytest.raises(InputError, match="reset_mask"):
            env.reset(options={"reset_mask": mask})
