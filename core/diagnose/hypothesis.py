"""A hypothesis: the device with some parameters multiplied."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Self

from pydantic import Field, model_validator

from core.block import BlockParams, Context, Oscillator, parameter
from core.diagnose.lanes import LANE


class NamedModel(BlockParams):
    """One model of a bank: the parameters of the nominal device that it takes for changed, and its name."""

    name: str = Field(
        min_length=1,
        max_length=24,
        pattern=r"^[^\s.\x00-\x1f\x7f]+$",
        description="a short name, without spaces or dots",
    )

    @property
    def is_nominal(self) -> bool:
        """Whether it takes nothing for changed."""
        usual = type(self).model_fields
        return all(value == usual[name].default for name, value in self if name != "name")


class Hypothesis(NamedModel):
    """One model of the bank, as factors on the nominal device."""

    mass: float = parameter(1.0, "mass over nominal", gt=0, le=100, live=False)
    stiffness: float = parameter(1.0, "stiffness over nominal", gt=0, le=100, live=False)
    damping: float = parameter(1.0, "damping over nominal", gt=0, le=100, live=False)
    gain: float = parameter(1.0, "drive gain over nominal", gt=0, le=100, live=False)

    def oscillator(self, nominal: Oscillator) -> Oscillator:
        """Return the device under this hypothesis."""
        return Oscillator(
            mass=nominal.mass * self.mass,
            damping=nominal.damping * self.damping,
            stiffness=nominal.stiffness * self.stiffness,
            force=nominal.force * self.gain,
        )


SEVEN_STEP = [
    Hypothesis(name="healthy"),
    Hypothesis(name="m+5", mass=1.05),
    Hypothesis(name="m+10", mass=1.10),
    Hypothesis(name="k+5", stiffness=1.05),
    Hypothesis(name="k+10", stiffness=1.10),
    Hypothesis(name="b+30", damping=1.30),
]
"""The six hypotheses of 5.2.4."""


def lacking(device: Oscillator) -> str:
    """Say why a device cannot have hypotheses, which are factors on mass and spring; "" if it can."""
    return "" if device.mass > 0.0 and device.stiffness > 0.0 else "needs a device with mass and spring"


class ModelList(BlockParams):
    """Parameters of any diagnoser that chooses between models."""

    hypotheses: Sequence[NamedModel]

    @property
    def count(self) -> int:
        """How many models there are."""
        return len(self.hypotheses)

    @property
    def nominal(self) -> int | None:
        """Which model takes nothing for changed, if one does."""
        return next((position for position, item in enumerate(self.hypotheses) if item.is_nominal), None)

    @model_validator(mode="after")
    def _distinct(self) -> Self:
        twice = [name for name, count in Counter(item.name for item in self.hypotheses).items() if count > 1]
        if twice:
            raise ValueError(f"hypothesis names must differ, {twice[0]} occurs twice")
        return self


class BankParams(ModelList):
    """Parameters of any diagnoser with a list of hypotheses."""

    hypotheses: list[Hypothesis] = Field(
        SEVEN_STEP,
        min_length=2,
        max_length=LANE,
        description="the models among which the diagnoser chooses",
        json_schema_extra={"unit": "", "live": False, "equation": "5.2.4"},
    )


def names_of(params: BlockParams) -> list[str]:
    """Return the names of the models a diagnoser chooses between; none where it chooses between none."""
    return [item.name for item in params.hypotheses] if isinstance(params, ModelList) else []


def hypotheses_of(params: BlockParams) -> list[Hypothesis]:
    """Return the factors a diagnoser chooses between; none where it chooses between none."""
    return params.hypotheses if isinstance(params, BankParams) else []


def assumed_noise(context: Context) -> float:
    """Return the sensor noise that a bank assumes: the noise of the sensor, at least a thousandth of a micrometre."""
    return context.assumed_noise_um
