"""Score: a diagnoser against the truth the bench knows."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from pydantic import BaseModel

from core.block import TICK, Block, Context, FloatArray, Port
from core.diagnose.hypothesis import BankParams
from core.diagnose.weights import likeliest

HELD = 20.0
"""Right verdicts in a row that count as recognised."""
TOLERANCE = 1e-3
STEPS = 64
COUNT, EVERY, FACTORS = range(3)
PROBABILITY, NIS, MASS, STIFFNESS, DAMPING, GAIN, OTHER, SET_STIFFNESS, SET_DAMPING = range(9)
WINNER, TRUTH, CORRECT, FALSE, DELAY = range(9, 14)
LAST_TRUTH, RUN, FOUND, SINCE, STEP, TOTAL, RIGHT, EXITS, NIS_SUM, NIS_COUNT, STARTED, WAS_RIGHT = range(12)
DELAYS = 12
CONFUSION = DELAYS + STEPS


def score_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Name the winner and the truth, and count."""
    n = int(p[COUNT])
    winner = likeliest(w, io[PROBABILITY], n)
    if not math.isfinite(w[io[PROBABILITY] + winner]):
        winner = -1
    truth = -1
    stiffness = w[io[SET_STIFFNESS]]
    damping = w[io[SET_DAMPING]]
    for i in range(n):
        a = FACTORS + 4 * i
        if (
            truth < 0
            and w[io[OTHER]] == 0.0
            and abs(w[io[MASS]] - p[a]) <= TOLERANCE * p[a]
            and abs(w[io[STIFFNESS]] - stiffness * p[a + 1]) <= TOLERANCE * stiffness * p[a + 1]
            and abs(w[io[DAMPING]] - damping * p[a + 2]) <= TOLERANCE * damping * p[a + 2]
            and abs(w[io[GAIN]] - p[a + 3]) <= TOLERANCE * p[a + 3]
        ):
            truth = i
    if s[STARTED] == 0.0 or truth != s[LAST_TRUTH]:
        s[STARTED] = 1.0
        s[LAST_TRUTH] = truth
        s[SINCE] = w[TICK]
        s[RUN] = 0.0
        s[FOUND] = 0.0
        s[WAS_RIGHT] = 0.0
        if truth >= 0:  # what no hypothesis names is never found
            s[STEP] += 1.0
            if s[STEP] <= STEPS:
                s[DELAYS + int(s[STEP]) - 1] = -1.0
        w[io[DELAY]] = -1.0
    s[TOTAL] += 1.0
    right = winner == truth and truth >= 0
    if right:
        s[RIGHT] += 1.0
        s[RUN] += 1.0
        if s[FOUND] == 0.0 and s[RUN] >= HELD:
            s[FOUND] = 1.0
            delay = w[TICK] - (HELD - 1.0) * p[EVERY] - s[SINCE]
            w[io[DELAY]] = delay
            if s[STEP] <= STEPS:
                s[DELAYS + int(s[STEP]) - 1] = delay
    else:
        s[RUN] = 0.0
        if s[FOUND] != 0.0 and s[WAS_RIGHT] != 0.0:
            s[EXITS] += 1.0
    s[WAS_RIGHT] = 1.0 if right else 0.0
    if truth >= 0 and winner >= 0:
        s[CONFUSION + truth * n + winner] += 1.0
        s[NIS_SUM] += w[io[NIS] + truth]
        s[NIS_COUNT] += 1.0
    w[io[WINNER]] = winner
    w[io[TRUTH]] = truth
    w[io[CORRECT]] = s[RIGHT] / s[TOTAL]
    w[io[FALSE]] = s[EXITS]


class Score(Block):
    """Scores a bank: share of right samples, delay of each step, exits from the truth.

    The delay is the number of samples from the change to the first of 20 right verdicts in a row; a false switch
    is an exit from the truth after that; the share counts every sample, transitions included. The truth is the
    hypothesis whose factors are those of the plant at this moment, -1 when there is none, as while a fault is there
    that no factor can say; then there is nothing to find, and no delay. The factors count from a device without any
    fault in the environment that is set: at another temperature, in a package without air, or old from the start, it
    is healthy, while a leak and ageing within the run are faults. The models of a bank stay those of a new device at
    300 K and 1 atm, so that it may well be wrong elsewhere. A bank whose probabilities are no numbers has no winner,
    and is not right.
    """

    title = "Score"
    inputs = (
        Port("probability", "1", "probabilities of the bank"),
        Port("nis", "1", "normalised residuals of the bank"),
        Port("mass_scale", "1", "true mass over nominal", source="effects.mass_scale"),
        Port("stiffness_scale", "1", "true stiffness over nominal", source="effects.stiffness_scale"),
        Port("damping_scale", "1", "true damping over nominal", source="effects.damping_scale"),
        Port("drive_gain", "1", "voltage at the comb over the voltage applied", source="effects.drive_gain"),
        Port("other", "1", "not zero while no hypothesis can be true", source="effects.other"),
        Port("set_stiffness", "1", "stiffness without any fault over nominal", source="environment.stiffness_scale"),
        Port("set_damping", "1", "damping without any fault over nominal", source="environment.damping_set"),
    )
    outputs = (
        Port("winner", "1", "index of the most probable hypothesis, -1 when probabilities are no numbers"),
        Port("truth", "1", "index of the hypothesis that is true, -1 for none"),
    )
    taps = (
        Port("correct_fraction", "1", "share of samples with the right winner"),
        Port("false_switches", "1", "exits from the truth after it was found"),
        Port("delay", "samples", "samples it took to find the present truth, -1 while it is not found"),
    )
    Params = BankParams

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the ticks between two verdicts and the factors of the hypotheses."""
        factors = [
            value for item in params.hypotheses for value in (item.mass, item.stiffness, item.damping, item.gain)
        ]
        return np.array([float(len(params.hypotheses)), context.every, *factors])

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Counters, delays of the steps, confusion matrix."""
        n = len(params.hypotheses)
        start = np.zeros(CONFUSION + n * n)
        start[LAST_TRUTH] = -2.0
        return start

    step = score_step


class Scores(BaseModel):
    """What has been scored so far."""

    names: list[str]
    winner: int
    truth: int
    correct_fraction: float
    false_switches: int
    delays: list[int | None]
    since_tick: int
    nis: float | None
    confusion: list[list[int]]


def read(state: FloatArray, names: list[str], winner: int) -> Scores:
    """Read the counters of a score block."""
    n = len(names)
    steps = min(int(state[STEP]), STEPS)
    delays = [None if value < 0 else int(value) for value in state[DELAYS : DELAYS + steps]]
    return Scores(
        names=names,
        winner=winner,
        truth=int(state[LAST_TRUTH]) if state[STARTED] else -1,
        correct_fraction=float(state[RIGHT] / max(state[TOTAL], 1.0)),
        false_switches=int(state[EXITS]),
        delays=delays,
        since_tick=int(state[SINCE]),
        nis=float(state[NIS_SUM] / state[NIS_COUNT]) if state[NIS_COUNT] else None,
        confusion=state[CONFUSION : CONFUSION + n * n].reshape(n, n).astype(int).tolist(),
    )
