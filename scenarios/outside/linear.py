"""Devices and loops as linear systems of python-control, and such systems as controllers.

Time is in seconds, as python-control has it; voltages are in V, displacements in um, velocities in um/s.
"""

from __future__ import annotations

from typing import Any, Literal

import control
import numpy as np

from core.board.outside import Sample
from core.control.pid import Pid
from core.errors import InputError, unknown
from scenarios.schema import Scenario

MS_PER_S = 1e3
READABLE = ("error", "reference", "model", "measured", "applied")
"""The inputs that a linear controller may read; the error is the model minus the measurement."""


def device(scenario: Scenario) -> Any:
    r"""Return the device as a continuous system from voltage (V) to displacement (um).

    .. math:: \ddot y=-\tfrac{\beta}{m}\dot y-\tfrac km y+\tfrac Fm u

    Mass, damping and stiffness are the values in its environment, without faults; the states are displacement and
    velocity. A plant of first order has one state.

    Parameters
    ----------
    scenario : Scenario
        A scenario of one displacement; of a plant that is not linear this is its behaviour near rest.

    Returns
    -------
    control.StateSpace

    Raises
    ------
    InputError
        For a plant with axes.
    """
    spec = scenario.spec
    if spec.axes:
        raise InputError("has several axes; a linear system is made of one displacement", "device.id")
    oscillator = spec.nominal
    stiffness_scale, damping_scale = spec.surroundings
    mass, force = oscillator.mass, oscillator.force
    stiffness, damping = oscillator.stiffness * stiffness_scale, oscillator.damping * damping_scale
    names = {"inputs": "voltage", "outputs": "displacement", "name": "device"}
    if mass == 0.0:
        rate = MS_PER_S / damping
        return control.ss([[-stiffness * rate]], [[force * rate]], [[1.0]], [[0.0]], states=["displacement"], **names)
    rate = MS_PER_S / mass
    a = [[0.0, 1.0], [-stiffness * rate * MS_PER_S, -damping * rate]]
    states = ["displacement", "velocity"]
    return control.ss(a, [[0.0], [force * rate * MS_PER_S]], [[1.0, 0.0]], [[0.0]], states=states, **names)


def sampled_device(scenario: Scenario) -> Any:
    """Return the device with the voltage held from sample to sample: exactly the linear plant."""
    return control.sample_system(device(scenario), interval_s(scenario), "zoh", name="sampled_device")


def interval_s(scenario: Scenario) -> float:
    """Return the sample interval of a scenario, s."""
    return scenario.spec.dt_ms / MS_PER_S


def pid(scenario: Scenario) -> Any:
    r"""Return the PID of a scenario as a sampled system from the error (um) to the voltage (V), off its limits.

    .. math:: C(z)=K_p+K_i\,dt\,\frac{z}{z-1}+K_d\,\frac{1-d}{dt}\,\frac{z-1}{z-d}

    Its share of the reference is not in it.
    """
    spec = scenario.spec
    if "pid" not in spec.controllers:
        raise InputError("this bench has no PID", "controller.kind")
    p = Pid.pack(spec.controllers["pid"].params, spec.context())
    z, dt_s = control.tf("z"), interval_s(scenario)
    derivative = p.kd * (1.0 - p.decay) / p.dt_ms * (z - 1) / (z - p.decay)
    law = p.kp + p.ki * p.dt_ms * z / (z - 1) + derivative
    system = control.ss(control.tf(law.num, law.den, dt_s))
    return control.ss(system, inputs="error", outputs="voltage", name="pid")


def closed_loop(scenario: Scenario, controller: Any) -> Any:
    """Return the loop of the sampled device and a controller, from model displacement to displacement, both um.

    Parameters
    ----------
    scenario : Scenario
        The bench.
    controller : control.StateSpace or control.TransferFunction
        From the error (um) to the voltage (V), sampled as the scenario is: `pid`, or a user's own.

    Raises
    ------
    InputError
        For another controller.
    """
    law = _sampled(_checked(controller, ("error",), "controller"), interval_s(scenario), "controller")
    loop = control.feedback(sampled_device(scenario) * law, 1)
    return control.ss(loop, inputs="model", outputs="displacement", name="closed_loop")


def _checked(system: Any, inputs: tuple[str, ...], field: str) -> Any:
    """Return a system of one output, or a gain as one, once it is seen that it can be computed sample by sample.

    Raises
    ------
    InputError
        When it is none.
    """
    if isinstance(system, int | float):
        system = control.tf([float(system)], [1.0])
    if not isinstance(system, control.StateSpace | control.TransferFunction):
        text = f"must be a StateSpace or a TransferFunction of python-control, got {type(system).__name__}"
        raise InputError(text, field, "control.ss and control.tf make them")
    if (system.ninputs, system.noutputs) != (len(inputs), 1):
        text = f"must have {len(inputs)} inputs and 1 output, has {system.ninputs} and {system.noutputs}"
        raise InputError(text, field, f"its inputs are {', '.join(inputs)}")
    if isinstance(system, control.StateSpace):
        numbers = [system.A, system.B, system.C, system.D]
    else:
        numbers = [*system.num[0], *system.den[0]]
        for above, below in zip(system.num[0], system.den[0], strict=True):
            if len(np.trim_zeros(above, "f")) > len(np.trim_zeros(below, "f")):
                raise InputError("is improper: it has more zeros than poles", field, "give it more poles")
    if not all(np.isfinite(one).all() for one in numbers):
        raise InputError("has coefficients that are not finite", field)
    return system


def _sampled(system: Any, dt_s: float, field: str) -> Any:
    """Return a system in states, once it is seen to be sampled as the bench is."""
    if system.isctime(strict=True):
        raise InputError("is continuous", field, "control.sample_system samples it")
    if system.dt not in (None, True) and not np.isclose(system.dt, dt_s, rtol=1e-9, atol=0.0):
        raise InputError(f"is sampled every {system.dt:g} s, the bench every {dt_s:g} s", field)
    return control.ss(system)


class LinearLaw:
    """A controller that is a linear system, for `combbench.run(..., law=...)`.

    Parameters
    ----------
    system : control.StateSpace or control.TransferFunction
        With one output, the voltage (V). A continuous one, whose time is in seconds, is sampled.
    scenario : Scenario
        The bench it is for.
    reads : tuple of str
        Its inputs, in their order.
    method : str
        How a continuous system is sampled: ``tustin``, or ``zoh``, its inputs held.

    Raises
    ------
    InputError
        When inputs or outputs do not fit, or it is sampled at another interval.
    """

    def __init__(
        self,
        system: Any,
        scenario: Scenario,
        reads: tuple[str, ...] = ("error",),
        method: Literal["tustin", "zoh"] = "tustin",
    ) -> None:
        for name in reads:
            if name not in READABLE:
                raise unknown("signal of a controller", name, READABLE, "reads")
        dt_s, system = interval_s(scenario), _checked(system, reads, "system")
        if system.isctime():
            system = control.sample_system(system, dt_s, method)
        self.system = _sampled(system, dt_s, "system")
        self._reads = reads
        self._state = np.zeros(self.system.nstates)

    def __call__(self, sample: Sample) -> float:
        """Return the voltage for a sample."""
        if sample.begins:
            self._state = np.zeros(self.system.nstates)
        values = {**sample._asdict(), "error": sample.model - sample.measured}
        u = np.array([values[name] for name in self._reads])
        voltage = self.system.C @ self._state + self.system.D @ u
        self._state = self.system.A @ self._state + self.system.B @ u
        return float(voltage[0])
