"""A campaign: one scenario at many points, each with many seeds."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any, Literal, Self

import numpy as np
from pydantic import Field, ValidationError, model_validator

from core.block import FloatArray
from core.device.spread import Tolerances, draw
from core.errors import InputError, from_validation, short
from core.table import Table, Words
from scenarios.campaign.point_table import MOST_PATHS, MOST_POINTS, PointTable
from scenarios.campaign.points import Contents, Point, Points, RowsAxis, Step, SweepAxis, Values
from scenarios.edit import with_values
from scenarios.key import run_key
from scenarios.library import get
from scenarios.reading import without_address
from scenarios.schema import Scenario
from scenarios.seeds import MAX_RUNS, Seeds


class Range(Table):
    """Range of a value."""

    min: float = Field(description="smallest value")
    max: float = Field(description="largest value")
    scale: Literal["linear", "log"] = Field("linear", description="how the points are spread between them")

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        if self.min >= self.max:
            raise ValueError("needs min < max")
        if self.scale == "log" and self.min <= 0:
            raise ValueError("needs min > 0 for a logarithmic scale")
        return self

    def at(self, share: FloatArray) -> FloatArray:
        """Return the values at shares from 0 to 1 of the range."""
        if self.scale == "linear":
            return self.min + (self.max - self.min) * share
        return self.min * np.exp(math.log(self.max / self.min) * share)


class LatinHypercube(Table):
    """Points spread evenly in every value at once (McKay, Beckman, Conover 1979)."""

    points: int = Field(ge=1, le=MOST_POINTS, description="number of points")
    seed: int = Field(1, ge=0, description="seed of the points")
    ranges: dict[str, Range] = Field(
        min_length=1, max_length=MOST_PATHS, description="ranges of values, by dotted paths of the scenario"
    )

    def values(self) -> dict[str, FloatArray]:
        """Return a column for each path: each value has one point in every stratum, in an order of its own."""
        generator = np.random.default_rng(self.seed)
        return {
            path: entry.at((generator.permutation(self.points) + generator.random(self.points)) / self.points)
            for path, entry in self.ranges.items()
        }


class ProcessDeviations(Table):
    """Standard deviations of a process that makes devices of the scenario's drawing."""

    devices: int = Field(ge=1, le=MOST_POINTS, description="number of devices")
    seed: int = Field(1, ge=0, description="seed of the devices")
    beam_bias_um: float = Field(Tolerances.beam_bias_um, ge=0, description="of the etch bias of beams, µm")
    comb_bias_um: float = Field(Tolerances.comb_bias_um, ge=0, description="of the etch bias of fingers, µm")
    thickness_um: float = Field(Tolerances.thickness_um, ge=0, description="of the structural thickness, µm")
    film_gap_um: float = Field(Tolerances.film_gap_um, ge=0, description="of the gas film under the plate, µm")
    youngs_modulus_gpa: float = Field(Tolerances.youngs_modulus_gpa, ge=0, description="of Young's modulus, GPa")

    def steps(self, base: Scenario) -> RowsAxis:
        """Return the numbers of each drawn device."""
        geometry = base.spec.device.geometry
        if geometry is None:
            raise InputError("has no drawing to vary; choose lcr-350", "device.id")
        tolerances = Tolerances(**self.model_dump(exclude={"devices", "seed"}))
        drawn = draw(geometry, tolerances, self.devices, self.seed).drawn
        return RowsAxis({f"device.geometry.{name}": column for name, column in drawn.items()}, "device")


class SweepVariant(Table):
    """One of several alternatives, such as a controller or a set of diagnosers."""

    name: str = Field(min_length=1, max_length=100, description="name in tables")
    set: Values = Field(description="values of the scenario, by dotted path")


class CampaignHead(Table):
    """The file of a campaign."""

    schema_: Literal[1] = Field(1, alias="schema", description="version of the notation")
    id: str = Field("sweep", pattern=r"^[a-z0-9][a-z0-9-]{0,63}$", description="short name")
    title: Words = Field("", max_length=200, description="title for people")
    scenario: str | dict[str, Any] = Field(description="id of the library, or a scenario")
    set: Values = Field({}, description="values of the scenario at all points, by dotted path")
    seeds: Seeds = Field(Seeds(), description='noise seeds of each point, "A:B" with both ends')
    variants: list[SweepVariant] = Field([], max_length=1000, description="alternatives, such as controllers")
    grid: dict[str, list[Any]] = Field({}, description="lists of values, by dotted paths of the scenario")
    points: PointTable | None = Field(None, description="points from outside, a row for each")
    latin_hypercube: LatinHypercube | None = Field(None, description="points spread evenly over ranges of values")
    process_spread: ProcessDeviations | None = Field(None, description="devices that a process draws")


class Sweep:
    """A campaign, checked except for its points.

    Attributes
    ----------
    document : dict
        The document it was read from.
    head : Head
        Its tables.
    points : sequence of Point
        Every combination of variant, grid, point of a table, hypercube and device.
    contents : sequence of str
        The hash of every point.
    """

    def __init__(self, document: dict[str, Any]) -> None:
        self.document = document = without_address(document)
        try:
            self.head = CampaignHead.model_validate(document)
        except ValidationError as error:
            raise from_validation(error, {"": [*FIELDS]}) from None
        source = self.head.scenario
        base = get(source) if isinstance(source, str) else Scenario.load(source)
        self.base = with_values(base, self.head.set)
        axes = self._axes()
        self._check_paths(axes)
        count = math.prod(len(axis) for axis in axes)
        if count > MOST_POINTS or count * self.head.seeds.count > MAX_RUNS:
            text = f"{count} points with {self.head.seeds.count} seeds each; at most {MOST_POINTS} points"
            raise InputError(f"{text} and {MAX_RUNS} runs", "grid", code="too_long")
        self.points = Points(axes, self.base.document)
        self.contents: Sequence[str] = Contents(self.points)

    @property
    def seeds(self) -> range:
        """The noise seeds of every point."""
        return range(self.head.seeds.first, self.head.seeds.first + self.head.seeds.count)

    def __len__(self) -> int:
        """Return the number of runs."""
        return len(self.points) * len(self.seeds)

    def key(self, number: int) -> str:
        """Return the key of a run; the seeds of the first point come first."""
        point, seed = divmod(number, len(self.seeds))
        return run_key(self.contents[point], self.seeds[seed])

    def runs(self) -> Iterator[tuple[str, Point, int]]:
        """Yield every run: its key, point and seed."""
        for point, content in zip(self.points, self.contents, strict=True):
            for seed in self.seeds:
                yield run_key(content, seed), point, seed

    def _axes(self) -> list[SweepAxis]:
        """Return the axes to combine: the steps of each, with their labels and values."""
        head = self.head
        axes: list[SweepAxis] = []
        if head.variants:
            _distinct([variant.name for variant in head.variants], "variants", "variants of one name")
            steps: list[Step] = [({"variant": variant.name}, variant.set) for variant in head.variants]
            axes.append(steps)
        for path, choices in head.grid.items():
            if not choices:
                raise InputError("needs at least one value", f"grid.{path}")
            labels = [_label(value) for value in choices]
            _distinct(labels, f"grid.{path}", "points of one value")
            axes.append([({path: label}, {path: value}) for label, value in zip(labels, choices, strict=True)])
        if head.latin_hypercube is not None:
            axes.append(RowsAxis(head.latin_hypercube.values()))
        if head.points is not None:
            axes.append(head.points.steps())
        if head.process_spread is not None:
            axes.append(head.process_spread.steps(self.base))
        return axes

    def _check_paths(self, axes: list[SweepAxis]) -> None:
        """Refuse settings that make the labels of points wrong: seeds that are not used, values written over."""
        head = self.head
        ranges = head.latin_hypercube.ranges if head.latin_hypercube is not None else {}
        listed = dict.fromkeys(head.points.paths) if head.points is not None else {}
        tables = {"set": head.set, "grid": head.grid, "latin_hypercube.ranges": ranges, "points.paths": listed}
        tables |= {f"variants.{position}.set": variant.set for position, variant in enumerate(head.variants)}
        for where, table in tables.items():
            if "seed" in table:
                raise InputError("the noise seeds of a campaign belong in [seeds]", f"{where}.seed", "set [seeds]")
        taken: set[str] = set()
        for axis in axes:
            some = 1 if isinstance(axis, RowsAxis) else len(axis)  # all rows set the same
            paths = {path for number in range(some) for path in axis[number][1]}
            for path in sorted(paths & taken):
                text = "has values in two of variants, grid, points, latin_hypercube and process_spread"
                raise InputError(text, path, "give them in one")
            taken |= paths


FIELDS = tuple("schema" if name == "schema_" else name for name in CampaignHead.model_fields)


def _distinct(labels: list[str | float], field: str, what: str) -> None:
    """Refuse repeated entries: their points would count twice in every table."""
    seen: set[str | float] = set()
    for position, label in enumerate(labels):
        if label in seen:
            raise InputError(f"two {what}: {short(label)}", f"{field}.{position}", "give each once")
        seen.add(label)


def _label(value: Any) -> str | float:
    """Write a value of a grid for a table."""
    return value if isinstance(value, str | int | float) and not isinstance(value, bool) else str(value)
