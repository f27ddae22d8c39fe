"""The task of following a reference model, for one board or for many; the environments of Gymnasium share it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from gymnasium.spaces import Box
from numpy.typing import NDArray

from core.block import BoolArray, FloatArray, IntArray
from core.board.board import Board
from core.board.driven import DRIVEN, DrivenBoards
from core.board.lane import Lane
from core.board.parse import changed
from core.board.pattern import Pattern, Uneven
from core.errors import InputError
from core.loop.guard import Guard
from scenarios.campaign.batch import shape, waiting
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.outside.constraints import NOTHING, Constraints
from scenarios.outside.episodes import Episode, Episodes, Ranges
from scenarios.outside.judge import KEPT, OBSERVED, observe, reward
from scenarios.outside.rewards import Reward, reward_of
from scenarios.outside.scope_picture import Picture, ScopePicture
from scenarios.run import DEFAULT_SAMPLES
from scenarios.schema import Scenario

Observation = NDArray[np.float32]
DRAWN = ("model.displacement", "plant.displacement", "drive.voltage")
"""Signals of a picture."""
MOST_SKIP = 10_000
NO_RANGES: Ranges = {}
FIRST, ONCE = np.zeros(1, dtype=np.int64), np.ones(1, dtype=np.int64)
"""The place of a board by itself, and its single tick."""
RENDER_MODES = ("rgb_array",)


class TaskOptions(NamedTuple):
    """Choices of an environment; `TrackingTask` explains them."""

    scenario: str | Scenario = "first-look"
    values: Mapping[str, Any] | None = None
    frame_skip: int = 1
    max_episode_steps: int | None = None
    reward: str | Reward = "tracking"
    draws: Ranges = NO_RANGES
    faults: Ranges = NO_RANGES
    constraints: Ranges = NO_RANGES
    on_violation: str = NOTHING
    penalty: float = 1.0
    render_mode: str | None = None


class StepOutcome(NamedTuple):
    """The end of a step of some boards."""

    seen: Observation
    rewards: FloatArray
    terminated: BoolArray
    truncated: BoolArray


class TrackingTask:
    r"""Boards whose shuttles should follow the reference model of a scenario.

    An action is the voltage held over ``frame_skip`` samples, as a share of the limit of the drive (-1 to 1). An
    observation has reference voltage and applied voltage over this limit, and model, measurement and error (the model
    minus the measurement) over the static travel that the limit causes. The reward is between 0 and 1, see
    `scenarios.outside.rewards.Reward`; a trip terminates the episode, so that it costs all later rewards. The end of
    the scenario truncates it.

    Parameters
    ----------
    count : int
        Boards.
    scenario : str or Scenario
        A library id, or a scenario; its events happen unchanged.
    values : dict, optional
        Fields of the scenario written over, by dotted paths.
    frame_skip : int
        Samples for which an action is held.
    max_episode_steps : int, optional
        Steps after which an episode is truncated, if the scenario has not ended before.
    reward : str or Reward
        ``tracking``, ``precise``, ``effort``, ``smooth``, or weights.
    draws, faults : mapping
        Values and faults that chance draws for each episode, see `scenarios.outside.episodes.Episodes`.
    constraints, on_violation, penalty
        See `scenarios.outside.constraints.Constraints`.
    render_mode : str, optional
        ``rgb_array``.

    Raises
    ------
    InputError
        For a scenario of another kind than one of a single displacement, with events at times alone; for options that
        are not allowed.
    """

    def __init__(self, count: int, options: TaskOptions) -> None:
        chosen = get(options.scenario) if isinstance(options.scenario, str) else options.scenario
        self.scenario = with_values(chosen, dict(options.values or {}))
        _check(self.scenario, options)
        self.options, self._samples = options, self.scenario.samples or DEFAULT_SAMPLES
        spec = changed(self.scenario.spec, DRIVEN)
        board = Board(spec)
        board.pending = waiting(self.scenario, board)
        events = board.pending.copy()
        self._episodes = Episodes(spec, events, self._samples, options.draws, options.faults)
        self._constraints = Constraints(
            options.constraints, board.signals.names, options.on_violation, float(options.penalty)
        )
        self._reward = reward_of(options.reward)
        columns = [*KEPT, *self._constraints.names]
        try:
            self._boards = DrivenBoards(Pattern(board), count, options.frame_skip, columns)
        except Uneven as error:
            raise InputError(f"no agent can drive this scenario: {error}", "scenario") from None
        self._drawn = [columns.index(name) for name in DRAWN]
        self._applied = columns.index("drive.voltage")
        self.limit_v = spec.context().limit_v
        self.scale_um, travel_um = _scale_um(self.scenario), float(_guard(self.scenario).travel_um)
        self._dt_ms = spec.dt_ms
        self._scales = 1.0 / np.array([self.limit_v, *[self.scale_um] * 3, self.limit_v])
        reach = travel_um / self.scale_um
        high = np.array([1.0, reach, reach, 2.0 * reach, 1.0], dtype=np.float32)
        self._high = high.astype(np.float64)
        self.observation_space = Box(-high, high, dtype=np.float32)
        self.action_space = Box(-1.0, 1.0, (1,), np.float32)
        self._seen = np.zeros((count, len(OBSERVED)), dtype=np.float32)
        self._before, self._steps = np.zeros(count), np.zeros(count, dtype=np.int64)
        self._values = np.zeros((count, len(self._constraints.names)))
        self.episodes: list[Episode | None] = [None] * count
        pictured = count if options.render_mode == "rgb_array" else 0
        self._pictures = [ScopePicture(2.0 * self.scale_um, self.limit_v) for _ in range(pictured)]

    @property
    def boards(self) -> list[Lane]:
        """The boards of these episodes, for inspection; an agent that learns from them cheats."""
        return self._boards.boards

    def begin(self, place: int, chance: np.random.Generator, options: Mapping[str, Any]) -> Observation:
        """Begin an episode, and return the first observation.

        Raises
        ------
        InputError
            For an option that is not allowed.
        """
        episode = self._episodes.next(chance, options)
        try:
            row = self._boards.begin(place, episode.spec, episode.pending)
        except Uneven:
            text = "make another bench than the one of the environment"
            raise InputError(text, "options.values", "make an environment with these values") from None
        self.episodes[place], self._steps[place], self._before[place] = episode, 0, row[self._applied]
        self._values[place] = 0.0
        seen = np.zeros((1, len(OBSERVED)))
        observe(row.reshape(1, 1, -1, 1), FIRST, ONCE, self._scales, self._high, seen)
        self._seen[place] = seen[0]
        if self._pictures:
            self._pictures[place].clear()
        begun: Observation = self._seen[place].copy()
        return begun

    def step(self, places: IntArray, actions: NDArray[Any]) -> StepOutcome:
        """Hold a voltage at each of some boards for a step."""
        voltages = self.limit_v * np.asarray(actions, dtype=np.float64).reshape(len(places))
        boards = self._boards
        boards.advance(places, voltages)
        tripped, rows = boards.gone[places], boards.rows
        counts: IntArray = boards.counts[places] - tripped
        rewards, before, seen = np.empty(len(places)), self._before[places], self._seen[places].astype(np.float64)
        reward(rows, places, counts, before, *self._reward, self.limit_v, rewards)
        observe(rows, places, counts, self._scales, self._high, seen)
        self._before[places], self._seen[places] = before, seen
        self._steps[places] += 1
        terminated, is_over = tripped, boards.ticks[places] >= self._samples
        if (most := self.options.max_episode_steps) is not None:
            is_over |= self._steps[places] >= most
        if self._constraints.names:
            values = self._values[places] = self._constraints.values(boards.kept(places)[:, len(KEPT) :], counts)
            violated = self._constraints.violated(values)
            rewards -= self._constraints.penalty * violated
            terminated = tripped | (violated if self._constraints.ends else False)
        if self._pictures:
            drawn = boards.kept(places)[:, self._drawn]
            for i, place in enumerate(places):
                self._pictures[place].add(drawn[: counts[i], :, i])
        return StepOutcome(self._seen[places], rewards, terminated, ~terminated & is_over)

    def draw(self, place: int) -> Picture:
        """Return the picture of a board."""
        return self._pictures[place].draw()

    def told(self, places: IntArray) -> dict[str, NDArray[Any]]:
        """Return where episodes are, and why they ended if they did, an array of each."""
        ticks = self._boards.ticks[places]
        trips = np.full(len(places), "", dtype=object)
        for i in np.flatnonzero(self._boards.gone[places]).tolist():
            trip = self._boards.boards[int(places[i])].trip
            trips[i] = trip.reason if trip else ""
        found = {"tick": ticks, "time_ms": ticks * self._dt_ms, "trip": trips}
        if self._constraints.names:
            values = self._values[places]
            found |= {"constraint_values": values, "constraint_violation": self._constraints.violated(values)}
        return found

    def told_of(self, place: int) -> dict[str, Any]:
        """Return the same of one episode, as plain values."""
        tick, trip = int(self._boards.ticks[place]), ""
        if self._boards.gone[place]:
            known = self._boards.boards[place].trip
            trip = known.reason if known else ""
        found: dict[str, Any] = {"tick": tick, "time_ms": tick * self._dt_ms, "trip": trip}
        if self._constraints.names:
            values = self._values[place].copy()
            found |= {"constraint_values": values, "constraint_violation": bool((values > 0.0).any())}
        return found

    def drawn(self, place: int) -> dict[str, Any]:
        """Return what chance and options have chosen for an episode."""
        episode = self.episodes[place]
        assert episode is not None
        return episode.drawn


def _check(scenario: Scenario, options: TaskOptions) -> None:
    """Refuse scenarios and options that no environment has."""
    for name, other in (("study", scenario.study), ("twins", scenario.twins)):
        if other:
            raise InputError("an agent drives one board, and nothing else", name, "leave it out")
    if shape(scenario) is None:
        text = "an agent drives a bench whose events come at times, without conditions and without a supervisor"
        raise InputError(text, "scenario", "leave these out")
    for name, most in (("frame_skip", MOST_SKIP), ("max_episode_steps", None)):
        value = getattr(options, name)
        if value is None and most is None:
            continue
        is_whole = isinstance(value, int) and not isinstance(value, bool)
        if not is_whole or value < 1 or (most is not None and value > most):
            raise InputError(f"must be a whole number from 1 to {most or 'any'}, got {value!r}", name)
    if options.render_mode not in (None, *RENDER_MODES):
        raise InputError(f"must be {' or '.join(RENDER_MODES)}, got {options.render_mode!r}", "render_mode")


def _guard(scenario: Scenario) -> Guard.Params:
    params = scenario.spec.guard.params
    assert isinstance(params, Guard.Params)
    return params


def _scale_um(scenario: Scenario) -> float:
    """Return the static travel under the limit of the drive, or the travel of the guard where this is less."""
    device, travel = scenario.spec.nominal, float(_guard(scenario).travel_um)
    force = abs(device.force) * scenario.spec.context().limit_v
    return min(travel, force / device.stiffness) if device.stiffness > 0.0 else travel
