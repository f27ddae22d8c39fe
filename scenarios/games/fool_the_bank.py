"""Fool the bank: name the largest fault that a bank of Kalman filters misses."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from core import registry
from core.block import Equation, parameter
from core.board.document import Document
from core.errors import InputError, unknown
from core.format import format_number, format_percent, format_short
from scenarios.games.draw import NOISE_SEEDS, Draws
from scenarios.games.edge import GAME, MISSED, RUNS, Edge, document
from scenarios.games.game import Fact, Game, GameInput, Kind, Outcome, device_fact
from scenarios.schema import Scenario

RANGES: dict[str, tuple[float, float]] = {
    "added_mass": (0.0, 1.0),
    "stiffness": (-0.5, 1.0),
    "damping": (-0.6, 2.0),
    "drive_gain": (-0.9, 1.0),
    "sensor_noise": (0.0, 5.0),
    "sensor_bias": (-5.0, 5.0),
    "sensor_hum": (0.0, 5.0),
    "sensor_quantisation": (0.0, 5.0),
}
"""The faults that may be named, and their ends."""
MECHANICAL = ("added_mass", "stiffness", "damping", "drive_gain")
"""A seed offers one of these, and two of the others, which change the measurement."""


def _kind(name: str) -> Kind:
    block = registry.block("faults", name)
    info = block.Params.model_fields["severity"]
    unit = info.json_schema_extra["unit"] if isinstance(info.json_schema_extra, dict) else ""
    low, high = RANGES[name]
    return Kind(name=name, title=block.title, unit=str(unit), minimum=low, maximum=high)


class Named(GameInput):
    """A fault and its severity."""

    fault: str = parameter("added_mass", "the fault that the bank shall miss")
    severity: float = parameter(0.01, "how severe it is; signed where the fault has both signs", ge=-5, le=5)


class FoolTheBank(Game[Named]):
    """Find the edge between the faults that a bank misses and those it finds."""

    id = GAME
    title = "Fool the bank"
    summary = (
        "A bank with its default settings watches a device: name a fault that is as large as can be and still missed."
    )
    task = (
        "The bank of six hypotheses knows the device and its noise. A seed offers three faults. Inject them on the "
        "bench and heal them again, and see how small a fault may be before the bank misses it. Then "
        "name a fault and a severity that it misses, as large as you dare. You have one attempt at each seed."
    )
    rule = (
        "The server lets the fault come in ten runs with noise seeds of its own. A run misses it if the bank says "
        "healthy in most of the last 10 ms of 50 ms after it; a wrong name is not a miss, for something was "
        "noticed. The bank misses the fault if at least nine runs do. A fault that it finds earns 0 points. One "
        "that it misses earns 100 at the edge, which is the smallest severity that the bank finds, and less the "
        "further away it is. The server looks for the edge from below, in steps of a factor of 1.41, and then "
        "halves the step, to 0.14 %: if the bank misses larger severities again, the first edge counts. A fault "
        "that the bank never finds up to the end of its range has no edge and earns nothing."
    )
    equations = (
        Equation("points", r"P=100\,\min\left(\frac{|s|}{s_e},\frac{s_e}{|s|}\right)\ \text{if missed, else } 0"),
    )
    attempts = 1
    form = Named

    def kinds(self, seed: int) -> list[Kind]:
        """Return the faults that can be named at a seed: one of the device or its drive, two of the measurement."""
        draws = Draws(self.id, seed)
        order = sorted(RANGES, key=draws.share)
        changed = [name for name in order if name in MECHANICAL][:1]
        return [_kind(name) for name in [*changed, *[name for name in order if name not in MECHANICAL][:2]]]

    def read(self, seed: int, values: Mapping[str, Any]) -> Named:
        """Check the fault named at a seed: one of its faults, within the range of that fault."""
        handed = super().read(seed, values)
        kinds = {one.name: one for one in self.kinds(seed)}
        if handed.fault not in kinds:
            raise unknown("fault", handed.fault, kinds, "fault")
        kind = kinds[handed.fault]
        if not kind.minimum <= handed.severity <= kind.maximum or handed.severity == 0.0:
            allowed = f"from {kind.minimum:g} to {kind.maximum:g} and not 0"
            raise InputError(f"must be {allowed} for {handed.fault}, got {handed.severity:g}", "severity")
        return handed

    def bench(self, seed: int, handed: Named | None = None) -> Document:
        """Return the live bench of a seed as a scenario; nothing happens on it by itself."""
        del handed
        return {**document(seed), "seed": Draws(self.id, seed).whole("live", NOISE_SEEDS)}

    def judge(self, seed: int, handed: Named) -> Outcome:
        """Return the points of the named fault, and the severity of the edge."""
        kind = _kind(handed.fault)
        size, end = abs(handed.severity), kind.maximum if handed.severity > 0.0 else kind.minimum
        bank = Edge(seed, handed.fault, end)
        missed, found = bank.missed_in(handed.severity), bank.find()
        worth = points(size, missed, None if found is None else abs(found))
        figures: dict[str, float] = {"missed_in": float(missed), "runs": float(RUNS)}
        count = f"The bank {'misses' if missed >= MISSED else 'finds'} {_amount(kind, handed.severity)}"
        count += f": missed in {missed} of {RUNS} runs."
        if found is None:
            never = f"It finds this fault nowhere up to {_amount(kind, end)}, so there is no edge and no points."
            return Outcome(points=0.0, figures=figures, said=f"{count} {never}", worked="P=0")
        figures["edge"] = found
        again = " Yours is beyond the edge, and the bank misses it again." if worth and size > abs(found) else ""
        words = f"{format_number(worth, 1)} points. The smallest it finds is {_amount(kind, found)}.{again}"
        sides = (size, abs(found)) if size <= abs(found) else (abs(found), size)
        worked = rf"P=100\cdot\frac{{{sides[0]:.4g}}}{{{sides[1]:.4g}}}={worth:.1f}" if worth else "P=0"
        return Outcome(points=worth, figures=figures, said=f"{count} {words}", worked=worked)

    def hidden(self, seed: int) -> list[Fact]:
        """Return the hidden values of a seed."""
        bench = Scenario.load(document(seed))
        noise = format_short(bench.document["sensor"]["noise_um"], "um")
        return [Fact(name="Sensor noise", said=noise), device_fact(bench)]


def points(size: float, missed: int, edge: float | None) -> float:
    """Return the points of a severity by the number of runs that missed it, and by the edge if there is one."""
    if missed < MISSED or edge is None:
        return 0.0
    return 100.0 * min(size / edge, edge / size)


def _amount(kind: Kind, severity: float) -> str:
    """Write a fault and how severe it is."""
    said = format_percent(severity, 2) if kind.unit == "1" else format_short(severity, kind.unit, 3)
    return f"{kind.title.lower()} of {said}"
