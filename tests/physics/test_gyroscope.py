"""The plants of gyroscopes against another integrator and closed forms; no board."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from core.block import Block, Context
from core.device.catalogue import device
from core.device.two_axis import TwoAxis
from core.errors import InputError
from core.plant.gyroscope import Gyroscope
from core.plant.gyroscope_pair import GyroscopePair
from tests.plant_alone import PlantAlone, held

PER_DEG = math.pi / 180.0
MOTION = ("x", "y", "x_velocity", "y_velocity")
SWING = {"initial_x_um": 1.0, "initial_y_um": -0.3, "initial_x_velocity_um_ms": 4.0, "initial_y_velocity_um_ms": 7.0}
START = np.array([1e-6, -0.3e-6, 4e-3, 7e-3])
"""The same in m and m/s."""
SETS = {  # kg, N/m and N s/m: x, y, xy
    "gyro-a": ((1.8e-7, 1.8e-7), (63.955, 95.92, 12.779), (1.8e-6, 1.8e-6, 3.6e-7)),
    "gyro-b": ((0.57e-8, 0.57e-8), (80.98, 71.62, 5.0), (4.29e-7, 6.87e-7, 4.29e-8)),
    "gyro-c": ((1.42e-6, 1.58e-6), (863.7569, 987.2898, 0.272048), (7.4945e-6, 8.7964e-5, 0.0)),
}
MIXED = np.array([[0.0, -1.0], [1.0, 0.0]])


def alone(
    name: str = "gyro-a",
    khz: float = 100.0,
    block: type[Block] = Gyroscope,
    over: dict[str, Any] | None = None,
    seed: int = 1,
    **params: Any,
) -> PlantAlone:
    """Return the plant of a device, without thermal noise unless asked for."""
    nominal = device({"id": name, "gyroscope": over or {}}).oscillator()
    context = Context(dt_ms=1.0 / khz, every=1, seed=seed, device=nominal, model=nominal)
    return PlantAlone(block, context, **{"thermal_noise": False, **params})


def other(name: str, start: np.ndarray, seconds: float, force: Any, deg_per_s: float) -> np.ndarray:
    """Integrate one sample in SI units with another method; ``force`` in N over the time within the sample."""
    masses, (kx, ky, kxy), (dx, dy, dxy) = SETS[name]
    inverse = np.diag(1.0 / np.array(masses))
    swirl = 2.0 * masses[1] * deg_per_s * PER_DEG * MIXED
    k, d = inverse @ np.array([[kx, kxy], [kxy, ky]]), inverse @ (np.array([[dx, dxy], [dxy, dy]]) + swirl)

    def slope(t: float, z: np.ndarray) -> np.ndarray:
        return np.concatenate([z[2:], inverse @ force(t) - k @ z[:2] - d @ z[2:]])

    # metres and seconds are scaled so that both halves of the state count alike
    rates = np.array([1e-6, 1e-6, 1e-2, 1e-2])
    found = solve_ivp(
        lambda t, z: slope(t, z * rates) / rates, (0, seconds), start / rates, "DOP853", rtol=1e-12, atol=1e-13
    )
    return np.asarray(found.y[:, -1] * rates)


@pytest.mark.parametrize("khz", [20, 100, 1000])
@pytest.mark.parametrize("name", SETS)
@pytest.mark.parametrize("kind", ["held", "analogue"])
def test_motion_is_that_of_another_integrator(name, khz, kind):
    """A rate that matters, forces of the size of the elastic ones; at 20 kHz a mode of B swings once in a sample."""
    plant, ticks, deg_per_s = alone(name, khz, **SWING), 60, 4e4
    draw = np.random.default_rng(5)
    forces = draw.uniform(-50.0, 50.0, (ticks, 2, 3))  # uN: axis; start, middle, end
    if kind == "held":
        forces[:] = forces[:, :, :1]

    def before(i: int) -> None:
        plant["rate"] = deg_per_s
        if i > 0:
            held(plant, "x", *forces[i - 1, 0])
            held(plant, "y", *forces[i - 1, 1])

    found = plant.play(ticks, *MOTION, before=before)
    h, z = 1e-3 / khz, START
    for i in range(1, ticks):
        values = 1e-6 * forces[i - 1]
        parabola = np.array([np.polyfit([0.0, 0.5, 1.0], row, 2) for row in values])
        z = other(name, z, h, lambda t, p=parabola: p @ np.array([(t / h) ** 2, t / h, 1.0]), deg_per_s)
        expected = z * np.array([1e6, 1e6, 1e3, 1e3])
        np.testing.assert_allclose(found[:2, i], expected[:2], atol=2e-10)
        np.testing.assert_allclose(found[2:, i], expected[2:], atol=2e-8)


def test_without_damping_energy_stays_and_the_rate_does_no_work():
    free = {"damping_x_ns_m": 1e-40, "damping_y_ns_m": 1e-40, "damping_xy_ns_m": 0.0}
    plant = alone("gyro-a", 50, over=free, **SWING)
    plant["rate"] = 1e5
    energy, x, y, vx, vy = plant.play(200_000, "energy", *MOTION)
    np.testing.assert_allclose(energy, energy[0], rtol=1e-11)
    # uN um of the motion itself
    again = 0.5 * (0.18 * (vx**2 + vy**2) + 63.955 * x**2 + 95.92 * y**2) + 12.779 * x * y
    np.testing.assert_allclose(energy, again, rtol=1e-12)


@pytest.mark.parametrize("deg_per_s", [100.0, -2000.0])
def test_the_line_of_oscillation_turns_by_minus_the_angle_turned(deg_per_s):
    r"""With z = x + jy the motion is :math:`\ddot z+2j\Omega\dot z+\omega^2z=0`, so that
    :math:`z=e^{-j\Omega t}\cos\sqrt{\omega^2+\Omega^2}\,t`."""
    like = {"stiffness_y_n_m": 63.955, "stiffness_xy_n_m": 0.0, "damping_xy_ns_m": 0.0}
    free = {"damping_x_ns_m": 1e-40, "damping_y_ns_m": 1e-40}
    rate, omega = deg_per_s * PER_DEG * 1e-3, math.sqrt(63.955 / 0.18)
    plant = alone("gyro-a", 100, over=like | free, initial_x_um=1.0, initial_y_velocity_um_ms=-rate)
    plant["rate"] = deg_per_s
    x, y, angle, area = plant.play(30_000, "x", "y", "angle", "area")
    t = 0.01 * np.arange(30_000)
    z = np.exp(-1j * rate * t) * np.cos(math.hypot(omega, rate) * t)
    np.testing.assert_allclose(x + 1j * y, z, atol=1e-10)
    turned = (angle + deg_per_s * t * 1e-3 + 90.0) % 180.0 - 90.0
    share = abs(rate) / omega  # the orbit is seen in axes that turn
    assert np.abs(turned).max() < share / PER_DEG
    assert np.abs(area).max() < 2 * math.pi * share


def test_a_circle_has_its_area():
    like = {"stiffness_y_n_m": 63.955, "stiffness_xy_n_m": 0.0, "damping_xy_ns_m": 0.0}
    omega = math.sqrt(63.955 / 0.18)
    plant = alone("gyro-a", 100, over=like, initial_x_um=2.0, initial_y_velocity_um_ms=2.0 * omega)
    plant.tick()
    assert plant["area"] == pytest.approx(math.pi * 4.0, rel=1e-12)
    assert plant["energy"] == pytest.approx(63.955 * 4.0, rel=1e-12)


def phasors(found: TwoAxis, omega: float, rate: float) -> tuple[complex, complex]:
    """Return y over x and the force along x over x of a device whose x swings at omega, with no force along y."""
    swirl = 2.0 * found.coriolis_mass * rate * MIXED
    system = found.stiffnesses - omega**2 * found.masses + 1j * omega * (found.dampings + swirl)
    ratio = -system[1, 0] / system[1, 1]
    return ratio, system[0, 0] + system[0, 1] * ratio


def tone(omega: float, factor: complex, i: int, khz: float, plant: PlantAlone, axis: str) -> None:
    """Drive with the force Im(factor exp(j omega t)) over the sample that starts at i."""
    start, middle, end = ((factor * np.exp(1j * omega * (i + part) / khz)).imag for part in (0.0, 0.5, 1.0))
    held(plant, axis, start, middle, end)


def measured(signal: np.ndarray, omega: float, khz: float) -> complex:
    """Return the phasor of a steady tone, of sin."""
    t = np.arange(len(signal)) / khz
    basis = np.column_stack([np.sin(omega * t), np.cos(omega * t)])
    a, b = np.linalg.lstsq(basis, signal, rcond=None)[0]
    return complex(a, b)


def driven(plant: PlantAlone, found: TwoAxis, omega: float, deg_per_s: float, ticks: int) -> dict[str, np.ndarray]:
    """Keep x at 1 um sin(omega t); x starts there and y at zero."""
    force = phasors(found, omega, deg_per_s * PER_DEG * 1e-3)[1]

    def before(i: int) -> None:
        plant["rate"] = deg_per_s
        if i > 0:
            tone(omega, force, i - 1, 100.0, plant, "x")

    return dict(zip("xy", plant.play(ticks, "x", "y", before=before), strict=True))


def test_scale_factor_with_split_modes():
    """C with y at zero reaches 258.6 pm per deg/s after many times its 36 ms, for 5 um of drive."""
    found: Any = device({"id": "gyro-c", "gyroscope": {"stiffness_xy_n_m": 0.0}})
    omega, rate = found.oscillator().drive_frequency, 10.0
    assert omega == pytest.approx(2 * math.pi * 3.92529, rel=1e-6)
    plant = alone("gyro-c", over={"stiffness_xy_n_m": 0.0}, initial_x_velocity_um_ms=omega)
    kept = driven(plant, found.oscillator(), omega, rate, 60_000)
    late = slice(40_000, None)
    ratio = abs(measured(kept["y"][late], omega, 100.0)) / abs(measured(kept["x"][late], omega, 100.0))
    assert 5e6 * ratio / rate == pytest.approx(258.6, rel=1.5e-3)
    assert 5e6 * ratio / rate == pytest.approx(found.metrics()["gyro.scale_pm_per_dps"], rel=2e-4)


@pytest.mark.parametrize(("name", "tilt", "zero"), [("gyro-2-2", 2.0, 10.00), ("gyro-4-5", 4.0, 18.37)])
def test_zero_rate_and_tilt_of_the_dissertations_pair(name, tilt, zero):
    found: Any = device({"id": name}).oscillator()
    omega = found.drive_frequency
    parts = []
    for deg_per_s in (-100.0, 0.0, 100.0):
        ratio, _ = phasors(found, omega, deg_per_s * PER_DEG * 1e-3)
        start = {"initial_y_um": ratio.imag, "initial_y_velocity_um_ms": omega * ratio.real}
        plant = alone(name, initial_x_velocity_um_ms=omega, **start)
        kept = driven(plant, found, omega, deg_per_s, 4000)
        x, y = (measured(kept[axis], omega, 100.0) for axis in "xy")
        parts.append(y / x)
    per_deg = (parts[2].imag - parts[0].imag) / 200.0
    assert parts[1].imag / per_deg == pytest.approx(zero, rel=2e-3)
    assert math.degrees(math.atan(parts[1].real)) == pytest.approx(tilt, rel=1e-3)
    assert abs(per_deg) * 1e6 == pytest.approx(3.705, rel=5e-3)


def test_effects_are_other_devices():
    """A device with a scaled or added effect equals a device that was made so."""
    plant, nominal = alone(**SWING), device({"id": "gyro-a"}).oscillator()
    assert isinstance(nominal, TwoAxis)
    scales = {"mass_scale": 1.1, "stiffness_scale": 0.9, "damping_scale": 3.0}
    seconds = {"second_stiffness_scale": 1.2, "second_damping_scale": 5.0}
    for port, value in {**scales, **seconds, "cross_stiffness": -2.0, "cross_damping": 1e-3}.items():
        plant[port] = value
    plant["drive_gain"], plant["second_drive_gain"] = 0.5, -2.0
    plant["acceleration"], plant["acceleration_side"] = 10.0, 20.0
    made = replace(
        nominal,
        mass=1.1 * nominal.mass,
        mass_y=1.1 * nominal.mass_y,
        coriolis_mass=1.1 * nominal.coriolis_mass,
        stiffness=0.9 * nominal.stiffness,
        stiffness_xy=0.9 * nominal.stiffness_xy - 2.0,
        stiffness_y=0.9 * 1.2 * nominal.stiffness_y,
        damping=3.0 * nominal.damping,
        damping_xy=3.0 * nominal.damping_xy + 1e-3,
        damping_y=3.0 * 5.0 * nominal.damping_y,
    )
    context = Context(dt_ms=0.01, every=1, seed=1, device=made, model=made)
    like = PlantAlone(Gyroscope, context, thermal_noise=False, **SWING)
    held(plant, "x", 4.0, 5.0, 6.0)
    held(plant, "y", 1.0)
    held(like, "x", *(0.5 * force - 1.1 * 0.18 * 10.0 for force in (4.0, 5.0, 6.0)))
    held(like, "y", -2.0 * 1.0 - 1.1 * 0.18 * 20.0)
    plant["rate"] = like["rate"] = 3000.0
    np.testing.assert_allclose(plant.play(500, *MOTION), like.play(500, *MOTION), rtol=0, atol=1e-10)


def test_a_fault_that_doubles_the_fastest_mode_is_still_integrated():
    stiff = 4.0
    made = device({"id": "gyro-b"}).oscillator()
    assert isinstance(made, TwoAxis)
    context = Context(dt_ms=0.01, every=1, seed=1, device=made.scaled(stiff, 1.0), model=made)
    like = PlantAlone(Gyroscope, context, thermal_noise=False, **SWING)
    plant = alone("gyro-b", **SWING)
    plant["stiffness_scale"] = stiff
    np.testing.assert_allclose(plant.play(300, *MOTION), like.play(300, *MOTION), rtol=0, atol=1e-9)


def test_a_pair_is_two_gyroscopes():
    """The partner starts without motion, takes its own forces, and feels the rate and the shaking of the frame."""
    pair = alone("gyro-4-5", block=GyroscopePair, partner={"id": "gyro-b", "gyroscope": {"alpha_deg": 3}}, **SWING)
    first, second = alone("gyro-4-5", **SWING), alone("gyro-b", over={"alpha_deg": 3})
    pair["mass_scale"] = first["mass_scale"] = 1.2  # a fault of the first
    pair["stiffness_scale"] = first["stiffness_scale"] = 1.5
    pair["partner_stiffness_scale"] = second["stiffness_scale"] = 1.1
    pair["partner_damping_scale"] = second["damping_scale"] = 2.0
    for plant in (pair, first, second):
        plant["rate"], plant["acceleration"], plant["acceleration_side"] = 500.0, 3.0, -4.0
    held(pair, "x", 1.0, 2.0, 3.0)
    held(first, "x", 1.0, 2.0, 3.0)
    for axis, forces in (("x", (5.0, 6.0, -1.0)), ("y", (-2.0, 0.0, 1.0))):
        held(second, axis, *forces)
        for port, value in zip(("force", "middle", "end"), forces, strict=True):
            pair[f"partner_{port}_{axis}"] = value
    both = pair.play(300, *MOTION, *(f"partner_{name}" for name in MOTION))
    np.testing.assert_array_equal(both[:4], first.play(300, *MOTION))
    np.testing.assert_array_equal(both[4:], second.play(300, *MOTION))


def test_a_sample_in_which_modes_swing_many_times_is_refused():
    with pytest.raises(InputError, match="19 times in a sample") as error:
        alone("gyro-b", 1)
    assert error.value.field == "sample_rate_khz"
    assert alone("gyro-b", 2).p is not None


def test_a_partner_must_be_a_gyroscope():
    for values, words in (
        ({"id": "ch3"}, "ch3 has one axis"),
        ({"id": "gyro"}, "unknown device 'gyro'"),
        ({"gyroscope": {"alpha_deg": 99}}, "alpha_deg: must be <= 90"),
    ):
        with pytest.raises(ValueError, match=words):
            alone(block=GyroscopePair, partner=values)
    assert GyroscopePair.Params().partner == device({"id": "gyro-2-2"})


def test_each_plant_refuses_devices_with_other_axes():
    one, two = device({}).oscillator(), device({"id": "gyro-a"}).oscillator()
    assert "one axis" in Gyroscope.unsuited(one, one) and not Gyroscope.unsuited(two, two)
    assert "one axis" in GyroscopePair.unsuited(one, one) and not GyroscopePair.unsuited(two, two)
