"""Linear systems of python-control, both ways: against closed forms, python-control's own simulation, and scipy."""

from __future__ import annotations

import math
from typing import Any

import control
import numpy as np
import pytest
import scipy.signal

from core.board.outside import Sample
from core.device.frequency import response
from core.errors import InputError
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.outside.linear import LinearLaw, closed_loop, device, interval_s, pid, sampled_device
from scenarios.run import run
from scenarios.schema import Scenario

QUIET = {
    "samples": 600,
    "diagnosers": {},
    "plant.drive_noise_v": 0.0,
    "plant.thermal_noise": False,
    "sensor.noise_um": 0.0,
}


def quiet(**values: Any) -> Scenario:
    return with_values(get("first-look"), {**QUIET, **values})


def test_the_device_has_the_frequency_response_of_its_compliance() -> None:
    """y/u = F / (k - m w^2 + j b w), in SI units, times 1e6 um/m."""
    scenario = quiet()
    hertz = np.geomspace(10.0, 50_000.0, 60)
    expected = scenario.spec.device.signed_force_n_per_v * response(**scenario.spec.device.resolved, frequency_hz=hertz)
    np.testing.assert_allclose(device(scenario)(2j * np.pi * hertz), 1e6 * expected, rtol=1e-12)


def test_the_environment_is_in_it() -> None:
    """At a lower pressure the air damps less, and the quality factor is the one the bench states."""
    scenario = quiet(**{"environment.pressure_pa": 5000.0})
    slowest = device(scenario).poles()[0]
    quality = abs(slowest) / (-2.0 * slowest.real)
    assert quality == pytest.approx(scenario.spec.quoted["quality_factor"], rel=1e-9)
    assert quality > 1.5 * quiet().spec.quoted["quality_factor"]


@pytest.mark.parametrize("name", ["first-order-gain", "second-order-gain", "unstable-first-order"])
def test_plants_given_as_transfer_functions(name: str) -> None:
    scenario = Scenario.load({"schema": 1, "device": {"id": name}, "samples": 10})
    given = scenario.spec.device.transfer_function
    unit_s = 1e-3 * scenario.spec.nominal.time_unit_ms
    s = 1j * np.geomspace(0.1, 10.0, 20)
    expected = given.gain / np.polyval(given.denominator, s)
    np.testing.assert_allclose(device(scenario)(s / unit_s), expected, rtol=1e-12)


def test_the_sampled_device_is_the_plant_of_the_board() -> None:
    """A voltage drawn at random, held from sample to sample, through both."""
    scenario, voltages = quiet(), np.random.default_rng(1).normal(size=QUIET["samples"])
    trace = run(scenario, law=lambda x: voltages[x.tick])
    expected = control.forced_response(sampled_device(scenario), inputs=voltages).outputs
    np.testing.assert_allclose(trace.signal("plant.displacement"), expected, rtol=1e-9, atol=1e-12)


def test_the_pid_of_the_bench_is_its_system() -> None:
    """The step of the loop in python-control, from the model, is the trace of the bench with its compiled PID."""
    scenario = quiet(controller={"kind": "pid"}, **{"model.kind": "damped"})
    trace = run(scenario)
    loop = closed_loop(scenario, pid(scenario))
    expected = control.forced_response(loop, inputs=trace.signal("model.displacement")).outputs
    np.testing.assert_allclose(trace.signal("plant.displacement"), expected, rtol=1e-7, atol=1e-9)
    assert np.ptp(expected) > 0.1


def test_a_linear_law_has_the_closed_loop_of_python_control() -> None:
    """A lead with an integrator in continuous time, sampled by Tustin's rule."""
    scenario = quiet(**{"model.kind": "damped"})
    s = control.tf("s")
    sign = np.sign(scenario.spec.nominal.force)
    lead = sign * (2.0 * (1.0 + s / 2e4) / (1.0 + s / 2e5) + 2000.0 / s)
    law = LinearLaw(lead, scenario)
    trace = run(scenario, law=law)
    sampled = control.sample_system(control.ss(lead), interval_s(scenario), "tustin")
    expected = control.forced_response(
        closed_loop(scenario, sampled), inputs=trace.signal("model.displacement")
    ).outputs
    np.testing.assert_allclose(trace.signal("plant.displacement"), expected, rtol=1e-7, atol=1e-9)
    assert trace.trip is None and np.ptp(expected) > 0.1


@pytest.mark.parametrize(("method", "rule"), [("tustin", "bilinear"), ("zoh", "zoh")])
def test_a_continuous_system_is_sampled_as_scipy_does(method: Any, rule: str) -> None:
    scenario, dt = quiet(), interval_s(quiet())
    numerator, denominator = [3.0, 40_000.0], [1.0, 9_000.0, 4e8]
    law = LinearLaw(control.tf(numerator, denominator), scenario, reads=("measured",), method=method)
    y = np.random.default_rng(2).normal(size=200)
    answers = [law(sample(tick, measured)) for tick, measured in enumerate(y.tolist())]
    b, a, _ = scipy.signal.cont2discrete((numerator, denominator), dt, rule)
    np.testing.assert_allclose(answers, scipy.signal.lfilter(b.ravel(), a, y), rtol=1e-8, atol=1e-12)


def sample(tick: int, measured: float) -> Sample:
    return Sample(tick == 0, tick, 0.01 * tick, 0.01, 5.0, 2.0, measured, 0.5, True)


def test_inputs_are_read_in_their_order_and_a_law_begins_anew() -> None:
    """x+ = x/2 + error, u = x + 2 reference + 3 applied: by hand."""
    system = control.ss([[0.5]], [[1.0, 0.0, 0.0]], [[1.0]], [[0.0, 2.0, 3.0]], 1e-5)
    law = LinearLaw(system, quiet(), reads=("error", "reference", "applied"))
    assert [law(sample(tick, 1.0)) for tick in (0, 1, 2)] == [11.5, 12.5, 13.0]
    assert law(sample(0, 1.0)) == 11.5


@pytest.mark.parametrize(
    ("system", "reads", "message"),
    [
        (control.ss([], [], [], [[1.0, 1.0]]), ("error",), "system: must have 1 inputs and 1 output, has 2 and 1"),
        (control.tf([1.0], [1.0, 0.5], 1e-3), ("error",), "system: is sampled every 0.001 s, the bench every 1e-05 s"),
        (control.tf([1.0], [1.0, 0.5]), ("displacement",), "reads: unknown signal of a controller"),
    ],
)
def test_a_system_that_does_not_fit_is_refused(system: Any, reads: tuple[str, ...], message: str) -> None:
    with pytest.raises(InputError) as refused:
        LinearLaw(system, quiet(), reads=reads)
    assert str(refused.value).startswith(message)


def test_a_plant_with_axes_has_no_such_system() -> None:
    with pytest.raises(InputError, match="several axes"):
        device(Scenario.load({"schema": 1, "device": {"id": "gyro-a"}, "samples": 10}))


NONE = {
    "is improper": [
        control.tf([1.0, 0.0], [1.0]),
        control.tf([1.0, 0.0, 0.0], [1.0, 1.0]),
        control.tf([1, 0], [1], 1e-5),
    ],
    "must be a StateSpace or a TransferFunction": [
        control.frd([1.0, 2.0], [1.0, 2.0]),
        scipy.signal.lti([1.0], [1.0, 1.0]),
        scipy.signal.dlti([1.0], [1.0, 0.5], dt=1e-5),
        control.nlsys(None, lambda t, x, u, p: u, inputs=1, outputs=1),
        np.eye(1),
        None,
    ],
    "not finite": [control.tf([math.nan], [1.0, 1.0]), control.ss([[math.inf]], [[1.0]], [[1.0]], [[0.0]])],
    "is sampled every 0.3 s": [control.tf([1.0], [1.0, 0.5], 0.3)],
}


@pytest.mark.parametrize(
    ("says", "system"), [(says, system) for says, all_of_them in NONE.items() for system in all_of_them]
)
def test_what_is_no_controller_is_refused_in_one_line(says: str, system: Any) -> None:
    for made in (LinearLaw, lambda given, scenario: closed_loop(scenario, given)):
        with pytest.raises(InputError, match=says) as refused:
            made(system, quiet())
        assert "\n" not in str(refused.value)


def test_a_number_is_a_gain() -> None:
    law = LinearLaw(2.0, quiet(), reads=("measured",))
    assert law(Sample(True, 0, 0.0, 0.01, 0.0, 0.0, 1.5, 0.0, True)) == 3.0
    assert closed_loop(quiet(), 2.0).nstates == 2
    with pytest.raises(InputError, match="is continuous"):
        closed_loop(quiet(), control.tf([1.0], [1.0, 1.0]))
