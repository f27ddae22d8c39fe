"""The seed of a game draws its numbers, each by its name, and its device; everyone with the seed gets the same."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from core.board.document import Document
from core.device.drawn import device_of
from core.diagnose.aliases import alias_map
from core.diagnose.hypothesis import Hypothesis
from core.elementary import exp, log
from scenarios.benchmark.track import DIGITS, share
from scenarios.edit import with_values
from scenarios.schema import Scenario

TONE_HZ, AMPLITUDE_V = 2000.0, 10.0
"""The drive of every game: one sine, as in section 5.2.4."""
TONES = [(TONE_HZ, AMPLITUDE_V)]
BENCH: Document = {
    "schema": 1,
    "sample_rate_khz": 50,
    "device": {"id": "ch3", "bias_v": 6.0, "force_n_per_v": 6.375e-9},
    "plant": {"model": "linear", "drive": "held", "thermal_noise": False},
    "reference": {"kind": "sine", "amplitude_v": AMPLITUDE_V, "frequency_hz": TONE_HZ},
    "controller": {"kind": "open_loop"},
    "sensor": {"kind": "ideal"},
}
"""The visible bench of every game, the bench of section 5.2.4: the nominal device, without the noise."""
USUAL = (0.75, 2.0)
"""Amplitude of a drawn device over the nominal amplitude; other devices are drawn again."""
NOISE_SEEDS = 2**53


@dataclass(frozen=True)
class Draws:
    """The draws of one game from one seed.

    Parameters
    ----------
    game : str
        Id of the game, so that two games with one seed have nothing in common.
    seed : int
        0 or more.
    """

    game: str
    seed: int

    def share(self, name: str) -> float:
        """Return a number from 0 up to 1."""
        return share(f"{self.game} {self.seed}", name)

    def whole(self, name: str, count: int) -> int:
        """Return a whole number from 0 up to a count."""
        return int(self.share(name) * count)

    def between(self, name: str, low: float, high: float) -> float:
        """Return a number between two, all equally likely, in a few digits."""
        return round(low + (high - low) * self.share(name), DIGITS)

    def ratio_between(self, name: str, low: float, high: float) -> float:
        """Return a number between two whose logarithm is equally likely everywhere, in a few digits."""
        return round(low * exp(log(high / low) * self.share(name)), DIGITS)

    def noise_seeds(self, count: int) -> list[int]:
        """Return the seeds of the noise that a hand-in is judged with."""
        return [self.whole(f"noise {number}", NOISE_SEEDS) for number in range(count)]

    def device(self) -> dict[str, float]:
        """Return the values of the hidden device: one of the process that moves neither too little nor too far."""
        nominal = Scenario.load(BENCH)
        usual = amplitude_um(nominal)
        turn = 0
        while True:
            values = device_of(nominal.spec.device, self.whole(f"device {turn}", 2**31))
            if USUAL[0] <= amplitude_um(with_values(nominal, values)) / usual <= USUAL[1]:
                return values
            turn += 1


def amplitude_um(bench: Scenario) -> float:
    """Return how far the healthy device of a bench moves, um."""
    healthy = Hypothesis(name="healthy")
    return alias_map([healthy], bench.spec.device.oscillator(), TONES).responses[0].amplitudes_um[0]


def distances(bench: Scenario, one: Hypothesis, others: Sequence[Hypothesis]) -> list[float]:
    r"""Return the distance between the motion of a device and the motions of others, um.

    .. math:: |Y_i-Y_j|,\qquad Y=\frac{f_gF}{kf_k-mf_m\omega^2+j\beta f_\beta\omega}V

    Parameters
    ----------
    bench : Scenario
        Has the device that hypotheses multiply.
    one : Hypothesis
        The device.
    others : sequence of Hypothesis
        The device from which the distance is measured.
    """
    nominal = bench.spec.device.oscillator()
    return [alias_map([one, other], nominal, TONES).pairs[0].distance_um for other in others]
