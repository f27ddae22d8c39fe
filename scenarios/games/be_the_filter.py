"""Be the filter: tune a bank of Kalman filters to an unknown device, noise and faults."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from core.block import Equation, FloatArray, parameter
from core.board.document import Document
from core.diagnose.hypothesis import Hypothesis
from core.errors import InputError
from core.format import format_number, format_percent, format_short
from scenarios.benchmark.figures import scores
from scenarios.games.draw import NOISE_SEEDS, distances
from scenarios.games.game import DIAGNOSER, Fact, Game, GameInput, Outcome, device_fact
from scenarios.games.states import DATA_SHEET_UM, GAME, GIVEN, SIXTH, UNKNOWN, HiddenState
from scenarios.run import run
from scenarios.schema import Scenario

RUNS = 5
"""Noise seeds of a hand-in."""
GUESS = 1.0 - 1.0 / (UNKNOWN + 1)
"""Brier's score of even odds on six."""


class FilterAssumptions(GameInput):
    """The assumptions of the bank, and a sixth hypothesis; factors of 1 mean none."""

    assumed_noise_scale: float = parameter(
        1.0,
        "factor on both variances that the bank assumes; R is scale times the square of 0.4 \N{MICRO SIGN}m",
        ge=0.01,
        le=100,
    )
    process_noise_v: float = parameter(
        0.3, "noise on the voltage that the bank assumes; Q is scale times its square", "V", ge=0.001, le=10
    )
    probability_floor: float = parameter(1e-3, "smallest probability of a hypothesis", ge=0, le=0.05)
    mass: float = parameter(
        1.0, "mass of a sixth hypothesis over the mass of the healthy device", ge=0.5, le=2, live=False
    )
    stiffness: float = parameter(1.0, "stiffness of a sixth hypothesis over the healthy one", ge=0.5, le=2, live=False)
    damping: float = parameter(1.0, "damping of a sixth hypothesis over the healthy one", ge=0.25, le=4, live=False)

    @property
    def sixth(self) -> Hypothesis | None:
        """The sixth hypothesis, if there is one."""
        said = Hypothesis(name=SIXTH, mass=self.mass, stiffness=self.stiffness, damping=self.damping)
        return None if said.is_nominal else said

    @property
    def hypotheses(self) -> list[Hypothesis]:
        """The five, and the sixth."""
        return [*GIVEN, *([self.sixth] if self.sixth else [])]

    @property
    def bank(self) -> Document:
        """The bank as a bench has it."""
        return {
            "kind": "mmae",
            "sensor_noise_um": DATA_SHEET_UM,
            "assumed_noise_scale": self.assumed_noise_scale,
            "process_noise_v": self.process_noise_v,
            "probability_floor": self.probability_floor,
            "hypotheses": [one.model_dump(exclude_defaults=True) for one in self.hypotheses],
        }


def document(hidden: HiddenState, settings: FilterAssumptions) -> Document:
    """Return the bench of a seed with the bank set so."""
    about = {"id": BeTheFilter.id, "title": BeTheFilter.title}
    return {**hidden.document, **about, "diagnosers": {DIAGNOSER: settings.bank}}


class Sixth(NamedTuple):
    """How a sixth hypothesis counts.

    Attributes
    ----------
    credit : float
        The part of its probability that counts for the unknown fault.
    nearest : int
        Place of the state among the five for which the rest counts.
    """

    credit: float
    nearest: int


def sixth_of(hidden: HiddenState, settings: FilterAssumptions) -> Sixth:
    r"""Return how the sixth hypothesis counts, :math:`w=\max(0,1-|Y_6-Y_x|/\min_j|Y_j-Y_x|)`."""
    if settings.sixth is None:
        return Sixth(0.0, 0)
    own, *given = distances(hidden.bench, hidden.unknown, [settings.sixth, *GIVEN])
    apart = distances(hidden.bench, settings.sixth, GIVEN)
    return Sixth(max(0.0, 1.0 - own / min(given)), apart.index(min(apart)))


class BeTheFilter(Game[FilterAssumptions]):
    """Tune the bank of an unknown device by proper scoring."""

    id = GAME
    title = "Be the filter"
    summary = (
        "A hidden device, a hidden noise, hidden faults: set the bank's assumptions, and give it a sixth hypothesis."
    )
    task = (
        "The bank knows the healthy device and five hypotheses. The noise is unknown to it: at scale 1 it assumes "
        "0.4 \N{MICRO SIGN}m at the sensor, and the truth is at least a quarter off. The device starts healthy. After "
        "30 ms of device time it changes every 20 ms, six times; twice to a fault outside the five. Watch "
        "the measurement and the bank, set R, Q and the floor, and give the bank a sixth hypothesis for the unknown "
        "fault."
    )
    rule = (
        "The server runs your bank with five noise seeds and compares its probabilities with the truth at every "
        "sample: 100 points for certainty in the truth throughout, 0 for even odds on six, fewer for answers "
        "that are worse than a guess. On average right probabilities earn most. During the unknown fault only the "
        "sixth hypothesis can be right, and only as far as its motion at 2 kHz is nearer to the motion of the "
        "fault than the motion of the nearest of the five is: all of its probability counts if the two "
        "move alike, none if it is no nearer. The rest counts for the one of the five that moves most like your "
        "sixth, so a copy of one of them changes next to nothing. The motion is one amplitude and one phase: other "
        "factors that move alike are as good."
    )
    equations = (
        Equation("points", r"P=100\left(1-\frac{B}{5/6}\right),\quad B=\overline{\textstyle\sum_c(q_c-o_c)^2}"),
        Equation(
            "sixth",
            r"q_6=w\,p_6,\quad q_{j^*}=p_{j^*}+(1-w)\,p_6,"
            r"\quad w=\max\left(0,\,1-\frac{|Y_6-Y_x|}{\min_{j\le5}|Y_j-Y_x|}\right)",
        ),
    )
    attempts = 5
    form = FilterAssumptions
    turned = ("assumed_noise_scale", "process_noise_v", "probability_floor")

    def bench(self, seed: int, handed: FilterAssumptions | None = None) -> Document:
        """Return the live bench of a seed as a scenario, the bank set to the answer."""
        hidden = HiddenState(seed)
        return {**document(hidden, handed or FilterAssumptions()), "seed": hidden.draws.whole("live", NOISE_SEEDS)}

    def judge(self, seed: int, handed: FilterAssumptions) -> Outcome:
        """Return the points of an answer, with the points of the default settings."""
        hidden = HiddenState(seed)
        usual, sixth = FilterAssumptions(), sixth_of(hidden, handed)
        brier, credit = _brier(hidden, handed, sixth), sixth.credit
        mean, ordinary = brier["all"], points(_brier(hidden, usual, sixth_of(hidden, usual))["all"])
        worth = points(mean)
        said = (
            f"{format_number(worth, 1)} points; the default settings earn {format_number(ordinary, 1)}. While one of "
            f"the five was true you earned {format_number(points(brier['given']), 1)}, during the unknown fault "
            f"{format_number(points(brier['unknown']), 1)}"
        )
        own = (
            f"; your sixth hypothesis counts by {format_percent(credit, 0)}." if handed.sixth else ", without a sixth."
        )
        return Outcome(
            points=worth,
            figures={
                "brier": mean,
                "brier_given": brier["given"],
                "brier_unknown": brier["unknown"],
                "credit": credit,
                "default_points": ordinary,
            },
            said=said + own,
            worked=rf"P=100\left(1-\frac{{{mean:.4f}}}{{{GUESS:.4f}}}\right)={worth:.1f},\quad w={credit:.2f}",
        )

    def hidden(self, seed: int) -> list[Fact]:
        """Return the hidden values of a seed."""
        one = HiddenState(seed)
        scale = one.noise_um**2 / DATA_SHEET_UM**2
        fault = ", ".join(
            f"{name} x {format_number(value, 3)}"
            for name, value in one.unknown.model_dump(exclude_defaults=True, exclude={"name"}).items()
        )
        names = [*(item.name for item in GIVEN), "unknown"]
        return [
            Fact(name="Sensor noise", said=f"{format_short(one.noise_um, 'um')}, scale {format_short(scale, '', 3)}"),
            Fact(name="Noise on the drive", said=format_short(one.drive_noise_v, "V", 3)),
            Fact(name="Unknown fault", said=fault),
            Fact(name="States", said=", ".join(names[state] for state in one.states)),
            device_fact(one.bench),
        ]


def points(brier: float) -> float:
    """Return the points of a Brier score: 100 for 0, none for the score of even odds."""
    return 100.0 * (1.0 - brier / GUESS)


def _brier(hidden: HiddenState, settings: FilterAssumptions, sixth: Sixth) -> dict[str, float]:
    """Return mean Brier scores over the noise seeds: of all samples, of the five states, of the unknown fault."""
    truth = hidden.truth
    scenario = Scenario.load({**document(hidden, settings), "samples": len(truth)})
    parts = {"all": truth >= 0, "given": truth != UNKNOWN, "unknown": truth == UNKNOWN}
    sums = dict.fromkeys(parts, 0.0)
    for seed in hidden.draws.noise_seeds(RUNS):
        result = run(scenario, seed, figures_only=True)
        if result.trip is not None:
            raise InputError(f"stopped at sample {result.trip.tick}: {result.trip.reason}", "game")
        said = [result.trace[f"{DIAGNOSER}.probability.{one.name}"] for one in settings.hypotheses]
        q = counted(said, sixth)
        for name, there in parts.items():
            sums[name] += scores(np.ascontiguousarray(q[:, there]), truth[there])[1]
    return {name: total / RUNS for name, total in sums.items()}


def counted(said: Sequence[FloatArray], sixth: Sixth) -> FloatArray:
    """Return the probability of each class, shape (6, samples): the five, and the unknown fault.

    Parameters
    ----------
    said : sequence of ndarray
        Probability of each hypothesis of the bank.
    sixth : Sixth
        Rule for the samples of the sixth.
    """
    q = np.zeros((UNKNOWN + 1, len(said[0])))
    for place, p in enumerate(said):
        q[place] = np.where(np.isfinite(p), p, 0.0)
    q[sixth.nearest] += (1.0 - sixth.credit) * q[UNKNOWN]
    q[UNKNOWN] *= sixth.credit
    return q
