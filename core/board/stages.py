"""The board as it is: the stages of a bench between device and sensor, and between drive and device."""

from __future__ import annotations

from core.block import Block
from core.board.spec import Section, Spec
from core.loop.amplifier import Amplifier
from core.loop.axis_amplifier import AxisAmplifier
from core.loop.axis_sampler import AxisSampler
from core.loop.sampler import Sampler


class BoardParams(Sampler.Params, Amplifier.Params):
    """The stages of a board around its converters; each is off at 0."""


class AxesBoardParams(AxisSampler.Params, AxisAmplifier.Params):
    """The stages of a board with axes around its converters; each is off at 0."""


STAGES = ("sampler", "amplifier")
"""Names of the stages; no block of a bench's own may have one, as a stage may come while the bench runs."""


def stages(spec: Spec) -> dict[str, Section]:
    """Return the stages that a bench has, by name; a stage that is off is left out."""
    blocks: tuple[type[Block], ...] = (AxisSampler, AxisAmplifier) if spec.axes else (Sampler, Amplifier)
    params = spec.board.params
    return {name: Section(block, params) for name, block in zip(STAGES, blocks, strict=True) if not block.rests(params)}


def behind(spec: Spec, family: str, signal: str) -> str:
    """Return the signal behind a stage: a plant reads the output of the amplifier, a sensor the motion as sampled.

    A law that is given a velocity as if it were measured is given the sampled velocity.
    """
    part, _, name = signal.partition(".")
    if family == "plant" and part == "drive":
        return f"amplifier.{name}"
    if family in ("sense", "control") and part == "plant":
        axis = name.removesuffix("_velocity")
        own = "displacement" if axis == name else "velocity"
        return f"sampler.{axis}.{own}" if axis in spec.axes else f"sampler.{name}"
    return signal
