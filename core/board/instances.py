"""The blocks of a bench, in the order of a tick."""

from __future__ import annotations

from typing import Any, NamedTuple

from core import registry
from core.block import Block, BlockParams
from core.board.spec import Spec
from core.diagnose.hypothesis import hypotheses_of
from core.loop.effects import Effects
from core.loop.measurement import Measurement
from core.loop.score import Score


class Instance(NamedTuple):
    """One block on the board: ``prefix`` is the first part of its signals' names."""

    key: str
    prefix: str
    block: type[Block]
    params: BlockParams
    every: int = 1


def instances(spec: Spec) -> list[Instance]:
    """Return the blocks of a bench in the order of a tick.

    The plant comes first: it integrates the sample that ends now, under the voltage and the effects that were held
    over it. Then the environment and the faults of this moment, what is measured and concluded, and the voltage to hold
    next.
    """

    def usual(key: str, section: Any) -> Instance:
        return Instance(key, key, section.block, section.params, section.every)

    def waiting(key: str, section: Any) -> Instance:
        return Instance(key, key, section.block, section.params, spec.turns(section))

    order = [usual("plant", spec.plant), usual("environment", spec.environment)]
    order.append(Instance("effects", "effects", Effects, Effects.Params()))
    for name, block in registry.blocks("faults").items():
        order.append(Instance(f"faults.{name}", f"faults.{name}", block, spec.faults.get(name) or usual_params(block)))
    # first what only detects, then what recovers a displacement from it
    for recovers in (False, True):
        order += [
            usual(name, section) for name, section in spec.sensors.items() if recovered(section.block) == recovers
        ]
    order.append(Instance("sensor", "sensor", Measurement, Measurement.Params()))
    order += [waiting(name, section) for name, section in spec.identifiers.items()]
    for name, section in spec.diagnosers.items():
        order.append(waiting(name, section))
        if scored(section.block):
            order.append(Instance(f"{name}.score", name, Score, _scored(section.params), spec.turns(section)))
    order += [usual("reference", spec.reference), usual("model", spec.model)]
    order += [usual(name, section) for name, section in spec.controllers.items()]
    order += [usual("drive", spec.drive), usual("guard", spec.guard)]
    return order


_USUAL: dict[type[Block], BlockParams] = {}


def usual_params(block: type[Block]) -> BlockParams:
    """Return the parameters of a fault that is not there, always the same ones."""
    if block not in _USUAL:
        _USUAL[block] = block.Params()
    return _USUAL[block]


def recovered(block: type[Block]) -> bool:
    """Say whether a sensor puts out a displacement."""
    return any(port.name == "displacement" for port in block.outputs)


def feeds_forward(block: type[Block]) -> bool:
    """Say whether a controller puts out its voltage between samples too, so that the drive may be analogue."""
    return any(port.name == "voltage_middle" for port in block.outputs)


def scored(block: type[Block]) -> bool:
    """Say whether a diagnoser chooses between hypotheses, so that it can be right or wrong."""
    return any(port.name == "probability" and port.each == "hypotheses" for port in block.outputs)


def _scored(params: BlockParams) -> BlockParams:
    return Score.Params.model_construct(hypotheses=hypotheses_of(params))
