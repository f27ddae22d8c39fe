"""The blocks of a bench, in the order of a tick."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from typing import Any, NamedTuple, cast

from core.block import Block, BlockParams, Context, FloatArray
from core.board.library import PLAIN, Library
from core.board.spec import Section, Spec
from core.board.stages import stages
from core.diagnose.arx import ArxBank
from core.diagnose.axes_bank import AxesBank
from core.diagnose.hypothesis import ModelList
from core.diagnose.kalman import KalmanBank
from core.diagnose.moving_bank import MovingBank
from core.errors import InputError
from core.identify.estimator import Estimator
from core.loop.axes_score import AxesScore
from core.loop.axis_measurement import AxisMeasurement
from core.loop.difference_states import DifferenceStates
from core.loop.effects import Effects
from core.loop.estimate_score import EstimateScore
from core.loop.measurement import Measurement
from core.loop.record_score import RecordScore
from core.loop.score import Score
from core.loop.weighted_axes import WeightedAxes
from core.loop.weighted_filters import WeightedFilters
from core.loop.weighted_parameters import WeightedParameters
from core.loop.weighted_state import WeightedState


class Instance(NamedTuple):
    """One block on the board: ``prefix`` is the first part of its signals' names."""

    key: str
    prefix: str
    block: type[Block]
    params: BlockParams
    every: int = 1
    axis: str = ""

    def packed(self, context: Context) -> FloatArray:
        """Return the numbers that its step reads on a bench; ``context`` holds the facts it may know.

        Raises
        ------
        InputError
            For parameters that this bench does not allow, with the field below the key.
        """
        try:
            return self.block.packed(self.params, context)
        except InputError as error:
            raise error.under(self.key) from None


@cache
def faults_of(axes: tuple[str, ...], library: Library = PLAIN) -> dict[str, type[Block]]:
    """Return the faults that a plant with these axes may have, by name."""
    return {name: block for name, block in library.blocks("faults").items() if block.fits(axes)}


@cache
def _absent_faults(library: Library, axes: tuple[str, ...]) -> dict[str, Instance]:
    """Return the faults that a plant with these axes may have, as they are while they are not there."""
    return {
        name: Instance(f"faults.{name}", f"faults.{name}", block, usual_params(block))
        for name, block in faults_of(axes, library).items()
    }


def instances(spec: Spec) -> list[Instance]:
    """Return the blocks of a bench in the order of a tick.

    The plant comes first: it integrates the sample that ends now, under the voltage and the effects that were held
    over it. Then the environment and the faults of this moment, the measurements and conclusions, and the voltage to
    hold next.
    """
    order = [_usual("plant", spec.plant), _usual("environment", spec.environment)]
    order.append(Instance("effects", "effects", Effects, Effects.Params()))
    for name, absent in _absent_faults(spec.library, spec.axes).items():
        order.append(absent._replace(params=spec.faults[name]) if name in spec.faults else absent)
    acting = stages(spec)
    order += _stage("sampler", acting, spec.axes) + _measured(spec)
    for name, section in spec.identifiers.items():
        order.append(_waiting(spec, name, section))
        if issubclass(section.block, Estimator):
            order.append(Instance(f"{name}.score", name, EstimateScore, EstimateScore.Params(), spec.turns(section)))
    for name, section in spec.diagnosers.items():
        order.append(_waiting(spec, name, section))
        if scored(section.block):
            order.append(_scoring(spec, name, section))
        order += _estimating(spec, name, section)
    order += [_usual(name, section) for name, section in spec.supervisors.items()]
    if spec.axes:
        order += [_usual(name, section) for name, section in spec.generators.items()]
    else:
        order += [_usual("reference", spec.reference), _usual("model", spec.model)]
    for slot in spec.driving:  # a later slot reads the outputs of an earlier slot
        order += [_usual(name, section) for name, section in spec.controllers.items() if section.block.slot == slot]
    order += [_usual(name, section) for name, section in spec.readouts.items()]
    order += _at_each_axis("drive", spec.drive, spec.axes) + _stage("amplifier", acting, spec.axes)
    return order + _at_each_axis("guard", spec.guard, spec.axes)


def _measured(spec: Spec) -> list[Instance]:
    """Return the sensors, and the block that passes on the measurement of the sensor in use."""
    order: list[Instance] = []
    # first the sensors that only detect, then the units that recover a displacement
    for recovers in (False, True):
        for name, section in spec.sensors.items():
            if recovered(section.block) == recovers:
                order += _at_each_axis(name, section, spec.axes if section.block.per_axis else ())
    measurement = AxisMeasurement if spec.axes else Measurement
    return order + _at_each_axis("sensor", Section(measurement, measurement.Params()), spec.axes)


def _stage(key: str, acting: dict[str, Section], axes: tuple[str, ...]) -> list[Instance]:
    """Return the instances of a stage of the board, none if it is off."""
    return _at_each_axis(key, acting[key], axes) if key in acting else []


def _at_each_axis(key: str, section: Section, axes: tuple[str, ...]) -> list[Instance]:
    """Return one instance for every axis, or the only one where there are none."""
    if not axes:
        return [_usual(key, section)]
    names = [(f"{key}.{axis}", axis) for axis in axes]
    return [Instance(name, name, section.block, section.params, section.every, axis) for name, axis in names]


def _usual(key: str, section: Section) -> Instance:
    return Instance(key, key, section.block, section.params, section.every)


def _waiting(spec: Spec, key: str, section: Section) -> Instance:
    """Return the instance of a block that reads measurements: it waits for the sensor's next measurement."""
    return Instance(key, key, section.block, section.params, spec.turns(section))


_USUAL: dict[type[Block], BlockParams] = {}


def usual_params(block: type[Block]) -> BlockParams:
    """Return the parameters of a fault that is not there, always the same ones."""
    if block not in _USUAL:
        _USUAL[block] = block.Params()
    return _USUAL[block]


def recovered(block: type[Block]) -> bool:
    """Say whether a sensor puts out a displacement."""
    return any(port.name == "displacement" for port in block.outputs)


def feeds_forward(block: type[Block], axes: tuple[str, ...] = ()) -> bool:
    """Say whether a controller puts out its commands between samples too, so that the drive may be analogue."""
    outputs = {port.name for port in block.outputs}
    commands = [axis for axis in axes if axis in outputs] if axes else ["voltage"]
    return all(f"{command}_middle" in outputs for command in commands)


def scored(block: type[Block]) -> bool:
    """Say whether a diagnoser chooses between hypotheses, so that it can be right or wrong."""
    return any(port.name == "probability" and port.each == "hypotheses" for port in block.outputs)


def _scoring(spec: Spec, name: str, section: Section) -> Instance:
    """Return the score of a diagnoser; for a plant with axes it counts the parts that may change along them."""
    block: Any = AxesScore if section.block.axes else Score
    labels: dict[str, Any] = {}
    if spec.record is not None:
        block, labels = RecordScore, {"labels": tuple(spec.record.hypotheses)}
    params = block.Params.model_construct(hypotheses=cast(ModelList, section.params).hypotheses, **labels)
    return Instance(f"{name}.score", name, block, params, spec.turns(section))


def _estimating(spec: Spec, name: str, section: Section) -> list[Instance]:
    """Return the blocks that weigh the models of a diagnoser, as far as its models have states and parameters."""
    has_equations = issubclass(section.block, ArxBank)
    every = spec.turns(section)
    found = []
    if has_equations:  # a bank of filters puts out its states itself
        found.append(Instance(f"{name}.states", name, DifferenceStates, section.params, every))
    if issubclass(section.block, MovingBank):
        weighing: type[Block] = WeightedFilters
    elif not scored(section.block):
        return []
    elif issubclass(section.block, AxesBank):
        weighing = WeightedAxes
    elif section.block.axes:
        return []
    else:
        weighing = WeightedState if has_equations or issubclass(section.block, KalmanBank) else WeightedParameters
    return [*found, Instance(weighted(name), weighted(name), weighing, section.params, every)]


def weighted(name: str) -> str:
    """Return the name of the weighted estimate of a diagnoser."""
    return f"{name}.weighted"


WEIGHING = (WeightedParameters, WeightedState, WeightedFilters, WeightedAxes, DifferenceStates)


def weighing_blocks(order: Iterable[Instance]) -> set[str]:
    """Return the blocks among these that only weigh the models of diagnosers."""
    return {one.key for one in order if one.block in WEIGHING}
