"""A hypothesis of a device with two axes: some of its parameters multiplied, a spring between the axes added."""

from __future__ import annotations

from dataclasses import replace

from pydantic import Field

from core.block import parameter
from core.device.two_axis import TwoAxis
from core.diagnose.hypothesis import ModelList, NamedModel
from core.diagnose.lanes import LANE
from core.units import rate_rad_ms


class AxesHypothesis(NamedModel):
    """One model of a bank of two axes, as factors on the nominal device and a quadrature added to its own."""

    stiffness: float = parameter(1.0, "stiffness of both axes over nominal", gt=0, le=100, live=False)
    mass: float = parameter(1.0, "mass over nominal", gt=0, le=100, live=False)
    damping: float = parameter(1.0, "damping over nominal", gt=0, le=100, live=False)
    second_stiffness: float = parameter(
        1.0, "stiffness along y over nominal, in addition to the change of both", gt=0, le=100, live=False
    )
    quadrature_dps: float = parameter(
        0.0, "added stiffness between the axes, read as a rate", "deg/s", ge=-1e6, le=1e6, live=False
    )
    drive_gain: float = parameter(1.0, "force along x over the one applied", gt=0, le=100, live=False)

    def cross_stiffness(self, nominal: TwoAxis) -> float:
        """Return the stiffness it adds between the axes, uN/um."""
        return nominal.cross_stiffness(rate_rad_ms(self.quadrature_dps))

    def device(self, nominal: TwoAxis) -> TwoAxis:
        """Return the device under this hypothesis; ``force`` is the gain along x."""
        scaled = nominal.scaled(self.stiffness, self.damping)
        return replace(
            scaled,
            mass=self.mass * nominal.mass,
            mass_y=self.mass * nominal.mass_y,
            coriolis_mass=self.mass * nominal.coriolis_mass,
            stiffness_xy=scaled.stiffness_xy + self.cross_stiffness(nominal),
            stiffness_y=self.second_stiffness * scaled.stiffness_y,
            force=self.drive_gain * nominal.force,
        )


FIVE_OF_AXES = [
    AxesHypothesis(name="healthy"),
    AxesHypothesis(name="quadrature+500", quadrature_dps=500.0),
    AxesHypothesis(name="drive-50", drive_gain=0.5),
    AxesHypothesis(name="sense+1", second_stiffness=1.01),
    AxesHypothesis(name="damping-x2", damping=2.0),
]
"""The usual faults, each at a severity worth finding."""


class AxesModels(ModelList):
    """Parameters of a diagnoser that chooses between models of two axes."""

    hypotheses: list[AxesHypothesis] = Field(
        FIVE_OF_AXES,
        min_length=2,
        max_length=LANE,
        description="the models among which the diagnoser chooses",
        json_schema_extra={"unit": "", "live": False, "equation": "5.2.4"},
    )
