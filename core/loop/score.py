"""Score: a diagnoser against the truth the bench knows."""

from __future__ import annotations

import math
from typing import Any

from pydantic import BaseModel

from core.block import Block, Context
from core.diagnose.hypothesis import BankParams
from core.diagnose.weights import winner_of
from core.ports import BlockPorts, output, reads, tap
from core.record import Record, Records, Vector, tail, vector

HELD = 20.0
"""Right verdicts in a row that count as recognised."""
TOLERANCE = 1e-3
STEPS = 64
"""Steps whose delays are kept."""


class Factors(Record):
    """A hypothesis, as factors on the nominal device."""

    mass: float
    stiffness: float
    damping: float
    gain: float


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
    lengths = ("hypotheses",)
    Params = BankParams

    class Packed(Record):
        """Number of hypotheses, ticks between two verdicts, the hypotheses."""

        count: float
        every: float
        hypotheses: Records[Factors] = tail()

    class State(Record):
        """The present truth and how far it is found, counters, delays of the steps, confusion matrix row by row."""

        truth: float
        run: float
        found: float
        since: float
        steps: float
        total: float
        right: float
        exits: float
        nis_sum: float
        nis_count: float
        started: float
        was_right: float
        delays: Vector = vector(STEPS)
        confusion: Vector = tail()

    class Ports(BlockPorts):
        """Probabilities of the bank, the true factors, and the verdict."""

        probability: Vector = reads("", "1", "probabilities of the bank")
        nis: Vector = reads("", "1", "normalised residuals of the bank")
        mass_scale: float = reads("effects.mass_scale", "1", "true mass over nominal")
        stiffness_scale: float = reads("effects.stiffness_scale", "1", "true stiffness over nominal")
        damping_scale: float = reads("effects.damping_scale", "1", "true damping over nominal")
        drive_gain: float = reads("effects.drive_gain", "1", "voltage at the comb over the voltage applied")
        other: float = reads("effects.other", "1", "not zero while no hypothesis can be true")
        set_stiffness: float = reads("environment.stiffness_scale", "1", "stiffness without any fault over nominal")
        set_damping: float = reads("environment.damping_set", "1", "damping without any fault over nominal")
        winner: float = output("1", "index of the most probable hypothesis, -1 when probabilities are no numbers")
        truth: float = output("1", "index of the hypothesis that is true, -1 for none")
        correct_fraction: float = tap("1", "share of samples with the right winner")
        false_switches: float = tap("1", "exits from the truth after it was found")
        delay: float = tap("samples", "samples it took to find the present truth, -1 while it is not found")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the ticks between two verdicts and the factors of the hypotheses."""
        p = cls.Packed.blank(len(params.hypotheses))
        p.count, p.every = len(params.hypotheses), context.every
        for factors, item in zip(p.hypotheses, params.hypotheses, strict=True):
            factors.mass, factors.stiffness = item.mass, item.stiffness
            factors.damping, factors.gain = item.damping, item.gain
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """Nothing counted."""
        s = cls.State.zeros(len(params.hypotheses) ** 2)
        s.truth = -2.0
        return s

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Name the winner and the truth, and count."""
        n = int(p.count)
        winner = winner_of(x.probability, n)
        if not math.isfinite(x.probability[winner]):
            winner = -1
        truth = -1
        stiffness = x.set_stiffness
        damping = x.set_damping
        for i in range(n):
            h = p.hypotheses[i]
            if (
                truth < 0
                and x.other == 0.0
                and abs(x.mass_scale - h.mass) <= TOLERANCE * h.mass
                and abs(x.stiffness_scale - stiffness * h.stiffness) <= TOLERANCE * stiffness * h.stiffness
                and abs(x.damping_scale - damping * h.damping) <= TOLERANCE * damping * h.damping
                and abs(x.drive_gain - h.gain) <= TOLERANCE * h.gain
            ):
                truth = i
        if s.started == 0.0 or truth != s.truth:
            s.started = 1.0
            s.truth = truth
            s.since = x.tick
            s.run = 0.0
            s.found = 0.0
            s.was_right = 0.0
            if truth >= 0:  # what no hypothesis names is never found
                s.steps += 1.0
                if s.steps <= STEPS:
                    s.delays[int(s.steps) - 1] = -1.0
            x.delay = -1.0
        s.total += 1.0
        right = winner == truth and truth >= 0
        if right:
            s.right += 1.0
            s.run += 1.0
            if s.found == 0.0 and s.run >= HELD:
                s.found = 1.0
                delay = x.tick - (HELD - 1.0) * p.every - s.since
                x.delay = delay
                if s.steps <= STEPS:
                    s.delays[int(s.steps) - 1] = delay
        else:
            s.run = 0.0
            if s.found != 0.0 and s.was_right != 0.0:
                s.exits += 1.0
        s.was_right = 1.0 if right else 0.0
        if truth >= 0 and winner >= 0:
            s.confusion[truth * n + winner] += 1.0
            s.nis_sum += x.nis[truth]
            s.nis_count += 1.0
        x.winner = winner
        x.truth = truth
        x.correct_fraction = s.right / s.total
        x.false_switches = s.exits


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


def read(s: Score.State, names: list[str], winner: int) -> Scores:
    """Read the counters of a score block."""
    n = len(names)
    delays = s.delays[: min(int(s.steps), STEPS)]
    return Scores(
        names=names,
        winner=winner,
        truth=int(s.truth) if s.started else -1,
        correct_fraction=float(s.right / max(s.total, 1.0)),
        false_switches=int(s.exits),
        delays=[None if value < 0 else int(value) for value in delays],
        since_tick=int(s.since),
        nis=float(s.nis_sum / s.nis_count) if s.nis_count else None,
        confusion=s.confusion.reshape(n, n).astype(int).tolist(),
    )
