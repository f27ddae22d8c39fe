r"""A device: the bench simulates it, and the controllers take it for true."""

from __future__ import annotations

import math
from functools import lru_cache, partial
from typing import Any, Self

from pydantic import ValidationError, model_validator

from core.block import BlockParams, Oscillator, parameter
from core.device import electrodes, levitation
from core.device.drawn_gyroscope import DrawnGyroscope
from core.device.electrodes import Electrodes
from core.device.environment import ROOM_K
from core.device.frequency import figures
from core.device.fringing import Fringing, fringing_factor
from core.device.geometry import Geometry
from core.device.gyroscope import GyroscopeTable
from core.device.ranges import BiasV, DampingNsM, Fingers, ForceNPerV, LengthUm, MassKg, Resonator, StiffnessNM
from core.device.transfer_function import TransferFunction
from core.device.two_axis import TwoAxis
from core.errors import InputError, from_validation
from core.units import BOLTZMANN, EPSILON_0, damping_un_ms_um, force_un_per_v, mass_mg, stiffness_un_um


class PrintedFigures(BlockParams):
    """Figures that the dissertation prints and that differ from the figures of the device's parameters."""

    mass_kg: float | None = parameter(None, "mass", "kg", gt=0, live=False)
    one_side_stiffness_n_m: float | None = parameter(None, "spring constant of one side", "N/m", gt=0, live=False)
    f0_hz: float | None = parameter(None, "resonant frequency", "Hz", gt=0, live=False)

    def metrics(self) -> dict[str, float]:
        """Return the printed figures under names that mark them as printed."""
        names = {
            "mass_kg": "mass_printed_kg",
            "one_side_stiffness_n_m": "one_side_stiffness_printed_n_m",
            "f0_hz": "f0_printed_hz",
        }
        return {names[name]: value for name, value in self.model_dump(exclude_none=True).items()}


OF_RESONATOR = (
    "mass_kg",
    "damping_ns_m",
    "stiffness_n_m",
    "force_n_per_v",
    "fingers",
    "thickness_um",
    "finger_gap_um",
    "fringing",
    "transfer_function",
    "printed",
)
"""Fields that a device with two axes has no use for."""


LCR_350 = Geometry()
"""The drawing of a device that has none."""


def _as_etched(drawn: Geometry, thickness_um: float | None, finger_gap_um: float | None) -> Geometry:
    """Return a drawing with the thickness and the gap of a device, as far as they are stated."""
    stated: dict[str, float] = {}
    if thickness_um is not None:
        stated["thickness_um"] = thickness_um
    if finger_gap_um is not None:
        stated["finger_gap_um"] = finger_gap_um - 2.0 * drawn.comb_bias_um
    return drawn.model_copy(update=stated) if stated else drawn


_usual_drawing = lru_cache(maxsize=256)(partial(_as_etched, LCR_350))


class Device(BlockParams):
    r"""A lateral comb resonator, from measured values or from its drawing.

    The drive is a push-pull comb (1.3.2): with the stators at :math:`+V_b` and :math:`-V_b`

    .. math:: F_e=\tfrac12\frac{dC}{dx}\left[(V_{b1}-v)^2-(V_{b2}-v)^2\right]
        =-4n\varepsilon_0\frac{t}{g}V_b\,v ,

    so a positive voltage pulls towards -x. Equation 5.2.1 puts *identical* voltages on both stators, which
    gives no force at all. The force assumes plates, unless ``fringing`` adds the field beyond them (1.5).

    Either mass, damping and stiffness are given, or ``geometry``; a value given in addition to a geometry wins. A
    ``transfer_function`` describes a plant that is no resonator, and has none of these. A gyroscope moves along two
    axes and is driven by forces, or by volts on its ``electrodes``: all its other numbers are in the table
    ``gyroscope``, or follow from ``geometry`` and ``drawn_gyroscope``.
    """

    id: str = parameter("custom", "name in the catalogue", live=False)
    title: str = parameter("", "what people read", live=False)
    source: str = parameter("", "where the numbers come from", live=False)
    mass_kg: MassKg | None = parameter(None, "effective mass", "kg", equation="1.3.3", live=False)
    damping_ns_m: DampingNsM | None = parameter(None, "damping", "N s/m", equation="1.3.7", live=False)
    stiffness_n_m: StiffnessNM | None = parameter(
        None, "stiffness of the whole suspension, 2 k_s", "N/m", equation="1.3.4", live=False
    )
    geometry: Geometry | None = parameter(None, "drawing", live=False)
    bias_v: BiasV = parameter(20.0, "bias of the first stator", "V", equation="1.3.2", live=False)
    opposite_bias_v: BiasV | None = parameter(
        None, "bias of the second stator; the negative of the first unless given", "V", live=False
    )
    force_n_per_v: ForceNPerV | None = parameter(
        None, "force per volt at the bias, magnitude; wins over the comb", "N/V", live=False
    )
    fingers: Fingers | None = parameter(None, "rotor fingers per side", live=False)
    thickness_um: LengthUm | None = parameter(None, "structural thickness", "um", live=False)
    finger_gap_um: LengthUm | None = parameter(None, "gap between fingers as etched", "um", live=False)
    fringing: Fringing | None = parameter(
        None,
        "field beyond the facing sides of fingers: over a grounded plane, or free of one; without effect beside "
        "force_n_per_v, which contains it",
        live=False,
    )
    transfer_function: TransferFunction | None = parameter(None, "of a plant that is no resonator", live=False)
    gyroscope: GyroscopeTable | None = parameter(None, "of a device with two axes", live=False)
    drawn_gyroscope: DrawnGyroscope | None = parameter(
        None, "data of a device with two axes in addition to the drawing", live=False
    )
    electrodes: Electrodes | None = parameter(None, "electrodes of a device with two axes", live=False)
    printed: PrintedFigures | None = parameter(None, "printed figures of the dissertation", live=False)

    @model_validator(mode="after")
    def _complete(self) -> Self:
        if self.usual_plant == "gyroscope":
            other = "geometry" if self.drawn_gyroscope is None else "gyroscope"
            besides = [name for name in (*OF_RESONATOR, other) if getattr(self, name) is not None]
            if besides:
                where = "its table" if self.drawn_gyroscope is None else "its drawing"
                raise ValueError(f"all numbers of a gyroscope belong in {where}; leave out {', '.join(besides)}")
            if self.drawn_gyroscope is not None and self.geometry is None:
                raise ValueError("drawn_gyroscope needs a geometry, the drawing of its parts")
            self.oscillator()
        elif self.electrodes is not None:
            raise ValueError("electrodes belong to a gyroscope; a resonator has its comb, fingers and gap")
        if self.usual_plant != "linear":
            return self
        missing = [
            name
            for name in ("mass_kg", "damping_ns_m", "stiffness_n_m")
            if getattr(self, name) is None and self.geometry is None
        ]
        if missing:
            raise ValueError(f"needs {', '.join(missing)}, or a geometry")
        comb = (self.fingers, self.thickness_um, self.finger_gap_um)
        if self.force_n_per_v is None and self.geometry is None and None in comb:
            raise ValueError("needs force_n_per_v, or fingers with thickness_um and finger_gap_um, or a geometry")
        if self.force_n_per_v is not None and self.bias_v == 0.0:
            raise ValueError("force_n_per_v is the force at the bias, so bias_v must not be 0")
        try:
            Resonator.model_validate(self.resolved)
        except ValidationError as error:
            raise ValueError(f"the drawing gives {from_validation(error)}") from None
        try:
            self.fringing_factor  # noqa: B018  (refuses a comb that it does not know)
        except InputError as error:
            raise ValueError(f"fringing {error.message}; {error.hint}") from None
        return self

    @property
    def usual_plant(self) -> str:
        """Name of the plant the device is usually simulated by."""
        if self.gyroscope is not None or self.drawn_gyroscope is not None:
            return "gyroscope"
        return "linear" if self.transfer_function is None else "transfer_function"

    @property
    def two_axes(self) -> GyroscopeTable | None:
        """Masses, stiffness and damping of a device with two axes, as given or as drawn."""
        if self.drawn_gyroscope is None or self.geometry is None:
            return self.gyroscope
        return self.drawn_gyroscope.table(self.geometry)

    @property
    def drawn_resonator(self) -> Geometry | None:
        """Drawing of a resonator; a gyroscope has the parts of its drawing, and other masses and stiffness."""
        return self.geometry if self.drawn_gyroscope is None else None

    @property
    def resolved(self) -> dict[str, float]:
        """Mass, damping and stiffness in SI units; for a gyroscope the values of the driven axis.

        Raises
        ------
        InputError
            For a transfer function, which has none.
        """
        if self.transfer_function is not None:
            raise InputError("is a transfer function, without mass or stiffness; choose a resonator", "device.id")
        if (axes := self.two_axes) is not None:
            return axes.drive_axis
        drawn: dict[str, Any] = {}
        if self.geometry is not None:
            drawn = {
                "mass_kg": self.geometry.mass_kg(),
                "damping_ns_m": self.geometry.damping_ns_m(),
                "stiffness_n_m": self.geometry.stiffness_n_m(),
            }
        for name in ("mass_kg", "damping_ns_m", "stiffness_n_m"):
            given = getattr(self, name)
            if given is not None:
                drawn[name] = float(given)
        return drawn

    @property
    def drawing(self) -> Geometry:
        """Drawing with the device's own thickness and gap; the drawing of LCR-350 when the device has none.

        Fingers given in addition to the drawing change the force alone: mass and damping belong to the drawn comb.
        """
        if self.geometry is None:
            return _usual_drawing(self.thickness_um, self.finger_gap_um)
        return _as_etched(self.geometry, self.thickness_um, self.finger_gap_um)

    @property
    def stators_v(self) -> tuple[float, float]:
        """Voltages of the two stators."""
        opposite = -self.bias_v if self.opposite_bias_v is None else self.opposite_bias_v
        return self.bias_v, opposite

    @property
    def fringing_factor(self) -> float:
        """dC/dx over dC/dx of plates; 1 beside a given force, which contains the fringing.

        Raises
        ------
        InputError
            For a comb outside the checked proportions.
        """
        if self.fringing is None or self.force_n_per_v is not None:
            return 1.0
        drawn = self.drawing
        return fringing_factor(self.fringing, drawn.finger_um, drawn.gap_um, drawn.thickness_um, drawn.film_gap_um)

    @property
    def capacitance_gradient(self) -> float:
        """dC/dx of one comb, F/m; a transfer function has no comb, and the combs of a gyroscope are its electrodes."""
        if self.usual_plant != "linear":
            return 0.0
        if self.force_n_per_v is not None:
            return self.force_n_per_v / (2.0 * abs(self.bias_v))
        drawn = self.drawing
        plates = 2.0 * (self.fingers or drawn.fingers) * EPSILON_0 * drawn.thickness_um / drawn.gap_um
        return plates * self.fringing_factor

    @property
    def signed_force_n_per_v(self) -> float:
        """Force per volt, N/V: -dC/dx (V_b1 - V_b2), zero for identical stators."""
        first, second = self.stators_v
        return -self.capacitance_gradient * (first - second)

    def _with_electrodes(self, device: TwoAxis) -> TwoAxis:
        own = self.electrodes or Electrodes()
        if self.drawn_gyroscope is None or self.geometry is None:
            return own.on(device, None, None)
        return own.on(device, self.geometry, self.drawn_gyroscope.sense(self.geometry))

    def oscillator(self) -> Oscillator:
        """Return the device in the units of the loop."""
        if self.transfer_function is not None:
            return self.transfer_function.oscillator()
        if (axes := self.two_axes) is not None:
            return self._with_electrodes(axes.two_axis())
        si = self.resolved
        return Oscillator(
            mass=mass_mg(si["mass_kg"]),
            damping=damping_un_ms_um(si["damping_ns_m"]),
            stiffness=stiffness_un_um(si["stiffness_n_m"]),
            force=force_un_per_v(self.signed_force_n_per_v),
        )

    def metrics(
        self, stiffness_scale: float = 1.0, damping_scale: float = 1.0, temperature_k: float = ROOM_K
    ) -> dict[str, float]:
        r"""Return the usual figures; :math:`f_0=\sqrt{k/m}/2\pi` with k of the whole suspension (1.3.5).

        Parameters
        ----------
        stiffness_scale, damping_scale : float
            Stiffness and damping in the environment, over nominal.
        temperature_k : float
            Temperature of the thermomechanical noise, :math:`x_{rms}=\sqrt{k_BT/k}`.
        """
        if self.transfer_function is not None:
            return self.transfer_function.metrics()
        si = self.resolved
        mass, force = si["mass_kg"], self.signed_force_n_per_v
        stiffness, damping = si["stiffness_n_m"] * stiffness_scale, si["damping_ns_m"] * damping_scale
        quoted = {
            "mass_kg": mass,
            "stiffness_n_m": stiffness,
            "damping_ns_m": damping,
            "thermal_rms_nm": math.sqrt(BOLTZMANN * temperature_k / stiffness) * 1e9,
            **figures(mass, damping, stiffness),
        }
        if (axes := self.two_axes) is not None:
            quoted |= axes.metrics(stiffness_scale, damping_scale, temperature_k)
            if self.drawn_gyroscope is not None and self.geometry is not None:
                scale = quoted["gyro.scale_pm_per_dps"]
                quoted |= self.drawn_gyroscope.metrics(self.geometry, stiffness_scale, scale)
            scaled = axes.two_axis().scaled(stiffness_scale, damping_scale)
            return quoted | electrodes.figures(self._with_electrodes(scaled))
        quoted |= {"force_n_per_v": abs(force), "static_gain_um_per_v": force / stiffness * 1e6}
        if self.fringing is not None and self.force_n_per_v is None:
            quoted["fringing_factor"] = self.fringing_factor
            if self.fringing == "grounded_plane":
                drawn = self.drawing
                beams = None if self.geometry is None else stiffness
                quoted |= levitation.figures(drawn, self.fingers or drawn.fingers, self.stators_v, beams)
        if self.printed is not None:
            quoted |= self.printed.metrics()
        return quoted
