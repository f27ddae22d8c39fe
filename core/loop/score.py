"""Score: a diagnoser against the truth the bench knows."""

from __future__ import annotations

import math
from typing import Any

from pydantic import BaseModel, Field

from core.block import Block, Context, Equation
from core.diagnose.chance import chi_square
from core.diagnose.hypothesis import BankParams
from core.diagnose.lanes import LANE
from core.diagnose.weights import winner_of
from core.kernel import kernel
from core.ports import BlockPorts, output, reads, tap
from core.record import Choice, Record, Records, Vector, tail, vector

HELD = 20.0
"""Right verdicts in a row that count as recognised."""
TOLERANCE = 1e-3
STEPS = 64
"""Steps whose delays are kept."""
EXITS = 8
"""False switches that are kept, the newest."""
SPAN = 25.0
"""Verdicts over which residuals are averaged, with weights that fall off exponentially."""
MOST_NIS = 100.0
"""The most that a single residual counts, so that a verdict is free again a hundred samples after the worst."""
CHANCE = 1e-6
"""Chance that sets the limit of the average; an average with decaying weights is over it in 6e-6 of verdicts."""


class Factors(Record):
    """A hypothesis, as factors on the nominal device."""

    mass: float
    stiffness: float
    damping: float
    gain: float


class ScoreTiming(Record):
    """Number of hypotheses, ticks between two verdicts, limit of an average of normalised residuals squared."""

    count: Choice
    every: Choice
    limit: float


class ScoredPorts(BlockPorts):
    """Probabilities of a bank in, the verdict out."""

    probability: Vector = reads("", "1", "probabilities of the bank")
    nis: Vector = reads("", "1", "normalised residuals of the bank")
    winner: float = output("1", "index of the most probable hypothesis, -1 when probabilities are no numbers")
    truth: float = output("1", "index of the hypothesis that is true, -1 for none")
    correct_fraction: float = tap("1", "share of samples with the right winner")
    false_switches: float = tap("1", "exits from the truth after it was found")
    delay: float = tap("samples", "samples it took to find the present truth, -1 while it is not found")
    least_nis: float = tap("1", "average normalised residual squared of what fits best; 1 where it is true")
    unexplained: float = tap("1", "1 while no hypothesis fits: even the least is too large for chance")


class Score(Block):
    r"""Scores a bank: share of right samples, delay of each step, exits from the truth.

    The delay is the number of samples from the change to the first of 20 right verdicts in a row; a false switch is an
    exit from the truth after that; the share counts every sample, transitions included. The truth is the hypothesis
    with the present factors of the plant, -1 when there is none, for example during a fault that no factor can
    describe; then there is nothing to find, and no delay. The factors count from a device without any fault in the
    environment that is set: at another temperature, in a package without air, or old from the start, it is healthy,
    while a leak and ageing within the run are faults. The models of a bank remain models of a new device at 300 K and 1
    atm, so that it may well be wrong elsewhere. A bank whose probabilities are no numbers has no winner, and is not
    right.

    A bank divides its belief among the hypotheses it has, and so it names one even if none is true. Its residuals
    decide: the residuals of a true hypothesis are as large as its filter expects. Verdicts are unexplained while the
    normalised residuals squared are too large for chance on average, for every hypothesis; an average with weights
    :math:`(1-1/25)^k` of white residuals is as good as an average of :math:`2\cdot25-1` samples.
    """

    title = "Score"
    lengths = ("hypotheses",)
    equations = (
        Equation("average", r"\bar\epsilon_i\leftarrow\bar\epsilon_i+\tfrac1W(r_i^2/\psi_i-\bar\epsilon_i)"),
        Equation(
            "unexplained",
            r"\min_i\bar\epsilon_i>\chi^2_{2W-1}(1-10^{-6})/(2W-1)",
            "Bar-Shalom, Li and Kirubarajan 2001, 5.4",
        ),
    )
    Params = BankParams

    class Packed(ScoreTiming):
        """In addition the hypotheses."""

        hypotheses: Records[Factors] = tail()

    class State(Record):
        """The present truth and how far it is found, counters, delays, newest exits, average residuals, confusion."""

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
        exit_tick: Vector = vector(EXITS)
        exit_samples: Vector = vector(EXITS)
        average: Vector = vector(LANE)
        confusion: Vector = tail()

    class Ports(ScoredPorts):
        """In addition the true factors."""

        mass_scale: float = reads("effects.mass_scale", "1", "true mass over nominal")
        stiffness_scale: float = reads("effects.stiffness_scale", "1", "true stiffness over nominal")
        damping_scale: float = reads("effects.damping_scale", "1", "true damping over nominal")
        drive_gain: float = reads("effects.drive_gain", "1", "voltage at the comb over the voltage applied")
        other: float = reads("effects.other", "1", "not zero while no hypothesis can be true")
        set_stiffness: float = reads("environment.stiffness_scale", "1", "stiffness without any fault over nominal")
        set_damping: float = reads("environment.damping_set", "1", "damping without any fault over nominal")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the ticks between two verdicts and the factors of the hypotheses."""
        p = cls.Packed.blank(len(params.hypotheses))
        take_turns(p, len(params.hypotheses), context)
        for factors, item in zip(p.hypotheses, params.hypotheses, strict=True):
            factors.mass, factors.stiffness = item.mass, item.stiffness
            factors.damping, factors.gain = item.damping, item.gain
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """Nothing counted."""
        return nothing_counted(len(params.hypotheses))

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Name the winner and the truth, and count."""
        n = int(p.count)
        truth = -1
        for i in range(n):
            if truth < 0:  # a condition of its own: boards abreast skip the rest once all have a truth
                if holds(p.hypotheses[i], x):
                    truth = i
        count(p, s, x, n, truth)


def take_turns(p: ScoreTiming, n: int, context: Context) -> None:
    """Pack the common fields of a score with this number of hypotheses."""
    samples = round(2.0 * SPAN) - 1
    p.count, p.every, p.limit = n, context.every, chi_square(samples, CHANCE) / samples


def nothing_counted(n: int) -> Score.State:
    """Return the state of an empty score with this number of hypotheses."""
    s = Score.State.zeros(n**2)
    s.truth = -2.0
    s.average[:] = 1.0
    return s


@kernel
def holds(h: Factors, x: Score.Ports) -> bool:
    """Return whether the factors of a hypothesis are the present factors of the plant."""
    stiffness = x.set_stiffness * h.stiffness
    damping = x.set_damping * h.damping
    return (
        x.other == 0.0
        and abs(x.mass_scale - h.mass) <= TOLERANCE * h.mass
        and abs(x.stiffness_scale - stiffness) <= TOLERANCE * stiffness
        and abs(x.damping_scale - damping) <= TOLERANCE * damping
        and abs(x.drive_gain - h.gain) <= TOLERANCE * h.gain
    )


@kernel
def count(p: ScoreTiming, s: Score.State, x: ScoredPorts, n: int, truth: int) -> None:
    """Compare the winner with the truth, and count."""
    winner = winner_of(x.probability, n)
    if not math.isfinite(x.probability[winner]):
        winner = -1
    if s.started == 0.0 or truth != s.truth:
        s.started = 1.0
        s.truth = truth
        s.since = x.tick
        s.run = 0.0
        s.found = 0.0
        s.was_right = 0.0
        if truth >= 0:  # a truth without a hypothesis is never found
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
        if s.found != 0.0:
            if s.was_right != 0.0:
                s.exits += 1.0
                for i in range(EXITS - 1):
                    s.exit_tick[i] = s.exit_tick[i + 1]
                    s.exit_samples[i] = s.exit_samples[i + 1]
                s.exit_tick[EXITS - 1] = x.tick
                s.exit_samples[EXITS - 1] = 0.0
            s.exit_samples[EXITS - 1] += p.every
    s.was_right = 1.0 if right else 0.0
    if truth >= 0 and winner >= 0:
        s.confusion[truth * n + winner] += 1.0
        s.nis_sum += x.nis[truth]
        s.nis_count += 1.0
    least = MOST_NIS
    for i in range(n):
        square = x.nis[i] if x.nis[i] < MOST_NIS else MOST_NIS  # also where it is no number
        s.average[i] += (square - s.average[i]) / SPAN
        least = min(least, s.average[i])
    x.winner = winner
    x.truth = truth
    x.correct_fraction = s.right / s.total
    x.false_switches = s.exits
    x.least_nis = least
    x.unexplained = 1.0 if least > p.limit else 0.0


class FalseSwitch(BaseModel):
    """A diagnoser that had found the truth turns to another verdict for some samples."""

    tick: int
    samples: int = Field(description="Samples until the verdict was true again, or the truth changed")


class Scores(BaseModel):
    """The score so far."""

    names: list[str]
    samples: int
    winner: int
    truth: int
    correct_fraction: float
    false_switches: int
    last_false_switches: list[FalseSwitch] = Field([], description="The newest false switches")
    delays: list[int | None]
    since_tick: int
    nis: float | None
    least_nis: float
    unexplained: bool
    confusion: list[list[int]]


def read(s: Score.State, names: list[str], winner: int, unexplained: bool) -> Scores:
    """Read the counters of a score block; winner and whether no hypothesis fits are among its signals."""
    n = len(names)
    kept = min(int(s.exits), EXITS)
    exits = zip(s.exit_tick[EXITS - kept :].tolist(), s.exit_samples[EXITS - kept :].tolist(), strict=True)
    delays = s.delays[: min(int(s.steps), STEPS)].tolist()
    return Scores.model_construct(  # of these kinds already
        names=names,
        samples=int(s.total),
        winner=winner,
        truth=int(s.truth) if s.started else -1,
        correct_fraction=float(s.right / max(s.total, 1.0)),
        false_switches=int(s.exits),
        last_false_switches=[
            FalseSwitch.model_construct(tick=int(tick), samples=int(samples)) for tick, samples in exits
        ],
        delays=[None if value < 0 else int(value) for value in delays],
        since_tick=int(s.since),
        nis=float(s.nis_sum / s.nis_count) if s.nis_sum else None,  # 0 from first to last where the bank has none
        least_nis=min(s.average[:n].tolist()),
        unexplained=unexplained,
        confusion=s.confusion.reshape(n, n).astype(int).tolist(),
    )
