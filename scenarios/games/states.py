"""The hidden values of a seed in the game Be the filter: a device, its noise, and an order of states."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from core.block import IntArray
from core.board.document import Document
from core.diagnose.hypothesis import Hypothesis
from scenarios.benchmark.track import DIGITS
from scenarios.edit import with_values
from scenarios.games.draw import BENCH, Draws, amplitude_um, distances
from scenarios.schema import Scenario

GAME = "be-the-filter"
GIVEN = (
    Hypothesis(name="healthy"),
    Hypothesis(name="m+5", mass=1.05),
    Hypothesis(name="m+10", mass=1.10),
    Hypothesis(name="k+5", stiffness=1.05),
    Hypothesis(name="b+30", damping=1.30),
)
UNKNOWN = len(GIVEN)
"""Class of the fault outside the five; the sixth is for it."""
SIXTH = "sixth"
FAULTS = {"mass": "added_mass", "stiffness": "stiffness", "damping": "damping"}
"""The fault that makes a factor true."""

DATA_SHEET_UM = 0.4
"""Sensor noise that the bank assumes at scale 1; the true one is at least a quarter off."""
NOISE_UM = ((0.15, 0.28), (0.55, 0.75))
DRIVE_V = (0.05, 0.8)
FACTORS = {"mass": (0.85, 1.25), "stiffness": (0.88, 1.15), "damping": (0.6, 1.8)}
"""Ends of the ranges of the unknown fault; two of the three are changed."""
APART = (0.12, 0.8)
"""Distance of the unknown fault from the nearest of the five, as a share of the healthy amplitude."""
FIRST, EACH, CHANGES = 1500, 1000, 6
"""Samples of the healthy beginning and of each of the states that come then, and how many these are."""


class HiddenState:
    """The hidden values of a seed.

    Attributes
    ----------
    device : dict
        Values of the device, by their paths.
    noise_um, drive_noise_v : float
        The true noise of sensor and drive.
    unknown : Hypothesis
        The fault outside the five.
    states : list of int
        The truth from each change on, the beginning first: places among the five, or `UNKNOWN`.
    """

    def __init__(self, seed: int) -> None:
        self.draws = draws = Draws(GAME, seed)
        self.device = draws.device()
        self.noise_um = draws.ratio_between("noise", *NOISE_UM[draws.whole("side", 2)])
        self.drive_noise_v = draws.ratio_between("drive", *DRIVE_V)
        self.bench = with_values(Scenario.load(BENCH), self.device)
        self.unknown = self._unknown()
        self.states = self._states()

    @property
    def document(self) -> Document:
        """The bench without its bank, as a scenario: the drawn device, its noise, and its events."""
        return {
            **self.bench.document,
            "plant": {**BENCH["plant"], "drive_noise_v": self.drive_noise_v},
            "sensor": {**BENCH["sensor"], "noise_um": self.noise_um},
            "events": self.events,
        }

    def _unknown(self) -> Hypothesis:
        """Draw the unknown fault: far enough from all of the five that it is distinguishable under the drive."""
        healthy, turn = amplitude_um(self.bench), 0
        while True:
            kept = self.draws.whole(f"kept {turn}", len(FACTORS))
            changed = [name for place, name in enumerate(FACTORS) if place != kept]
            factors = {name: round(self.draws.between(f"{name} {turn}", *FACTORS[name]), 3) for name in changed}
            one = Hypothesis(name=SIXTH, **factors)
            if APART[0] <= min(distances(self.bench, one, GIVEN)) / healthy <= APART[1]:
                return one
            turn += 1

    def _states(self) -> list[int]:
        """Draw the order of the states: the unknown fault twice, healthy once more, three others; each is a change."""
        others = sorted(range(1, UNKNOWN), key=lambda place: self.draws.share(f"which {place}"))
        turn = 0
        while True:
            drawn = [UNKNOWN, UNKNOWN, 0, *others[: CHANGES - 3]]
            order = sorted(range(CHANGES), key=lambda place: self.draws.share(f"order {turn} {place}"))
            states = [0, *(drawn[place] for place in order)]
            if all(before != after for before, after in pairwise(states)):
                return states
            turn += 1

    @property
    def truth(self) -> IntArray:
        """The class that is true at each sample of a run."""
        return np.repeat(np.array(self.states, dtype=np.int64), [FIRST, *[EACH] * CHANGES])

    @property
    def events(self) -> list[Document]:
        """The changes, as events of a scenario; the device is healthy again at the end."""
        found: list[Document] = []
        for number, state in enumerate([*self.states[1:], 0]):
            at = {"at_sample": FIRST + EACH * number}
            one = self.unknown if state == UNKNOWN else GIVEN[state]
            said = one.model_dump(exclude_defaults=True, exclude={"name"})
            faults = [
                {**at, "fault": FAULTS[name], "severity": round(value - 1.0, DIGITS)} for name, value in said.items()
            ]
            found += [{**at, "heal": "all"}, *faults]
        return found
