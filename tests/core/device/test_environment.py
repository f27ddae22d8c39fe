"""Laws of air, temperature, humidity and age against closed forms and limits."""

from __future__ import annotations

import math

import pytest
from scipy.constants import R, k

from core.board.parse import parse
from core.device import environment as law
from core.device.catalogue import device
from core.loop.environment import Environment
from scenarios.measure.metrics import device_metrics
from tests.lab import inject, make, play
from tests.two_axis import GYRO

MOLAR = 0.0289647  # kg/mol, dry air


def scales(**air):
    spec = parse({"device": {"id": air.pop("device", "ch3")}, "environment": air})
    return Environment.scales(spec.environment.params, spec.context())


def quality(**air):
    spec = parse({"device": {"id": air.get("device", "ch3")}})
    stiffness, damping = scales(**air)
    return spec.device.metrics(stiffness, damping)["quality_factor"]


def test_viscosity_by_sutherland():
    assert law.viscosity(300.0) == pytest.approx(1.846e-5, rel=1e-3)
    assert law.viscosity(273.15) == pytest.approx(1.716e-5, rel=1e-12)
    # hot gases: the square root of the temperature
    assert law.viscosity(4e8) / law.viscosity(1e8) == pytest.approx(2.0, rel=1e-5)


def test_density_and_mean_free_path():
    assert law.gas_density(101325, 300) == pytest.approx(101325 * MOLAR / (R * 300), rel=1e-3)
    assert law.mean_free_path_um(101325, 300) == pytest.approx(0.0670, rel=1e-3)
    molecule = MOLAR / (R / k)
    expected = law.viscosity(300) / 2e3 * math.sqrt(math.pi * k * 300 / (2 * molecule)) * 1e6
    assert law.mean_free_path_um(2e3, 300) == pytest.approx(expected, rel=1e-3)


def test_thin_gas_ends_at_the_free_molecular_value():
    pressure = 1e-3
    path = law.mean_free_path_um(pressure, 300)
    found = law.couette(law.viscosity(300), 1e6, 2.0, path)
    assert found == pytest.approx(pressure * 1e-6 * math.sqrt(MOLAR / (2 * math.pi * R * 300)), rel=1e-3)
    assert law.couette(law.viscosity(300), 1e6, 2.0, 0.0) == pytest.approx(law.viscosity(300) * 1e-6 / 2e-6)


def test_penetration_depth():
    assert law.penetration_depth_um(101325, 300, 2 * math.pi * 2484) == pytest.approx(44.84, rel=1e-3)


@pytest.mark.parametrize(
    ("pressure", "ratio", "q"),
    [
        (3e4, 0.862, 5.6),
        (1e4, 0.630, 7.7),
        (3e3, 0.326, 14.9),
        (1e3, 0.138, 35.0),
        (1e2, 0.0164, 297.0),
        (10, None, 2400),
    ],
)
def test_quality_factor_against_pressure(pressure, ratio, q):
    assert quality(pressure_pa=pressure) == pytest.approx(q, rel=0.02)
    if ratio is not None:
        assert scales(pressure_pa=pressure)[1] == pytest.approx(ratio, rel=5e-3)


def test_pressure_only_damps_and_the_suspension_has_the_last_word():
    assert scales(pressure_pa=100)[0] == 1.0
    assert quality(pressure_pa=0.01) == pytest.approx(law.STRUCTURAL_QUALITY, rel=0.02)
    falling = [quality(pressure_pa=p) for p in (0.1, 1, 10, 100, 1e3, 1e4, 101325, 1e6)]
    assert falling == sorted(falling, reverse=True)


def test_exactly_nothing_at_300_k_and_1_atm():
    for entry in ("ch3", "ch4", "lcr-350", "table-1-1-500-max"):
        assert scales(device=entry) == (1.0, 1.0)
        assert scales(device=entry, humidity_pct=95.0) == (1.0, 1.0)


def test_temperature_coefficient_of_the_resonance():
    def f0(kelvin):
        stiffness, damping = scales(temperature_k=kelvin)
        return parse({"device": {"id": "ch3"}}).device.metrics(stiffness, damping)["f0_hz"]

    assert (f0(301) - f0(299)) / 2 / f0(300) * 1e6 == pytest.approx(-31.5, rel=0.05)
    for celsius, hertz in ((-40, 2489.0), (27, 2483.8), (85, 2479.2), (125, 2476.1)):
        assert f0(celsius + 273.15) == pytest.approx(hertz, abs=0.06)


def test_warm_air_damps_more():
    """Viscosity rises by Sutherland, the slip with the mean free path takes a little back."""
    for kelvin in (233.15, 358.15, 398.15):
        damping = scales(temperature_k=kelvin)[1]
        stiffer = law.viscosity(kelvin) / law.viscosity(300)
        assert abs(damping - 1) < abs(stiffer - 1)
        assert damping == pytest.approx(stiffer, rel=0.05)


def test_damping_over_the_temperature_by_1_3_7_with_slip():
    """Areas of LCR-350 in um^2, film 2.0033 um and gap 2.1 um, each wider by twice the mean free path; Stokes above."""

    def sheared(kelvin):
        viscosity = 1.716e-5 * (kelvin / 273.15) ** 1.5 * 383.55 / (kelvin + 110.4)
        path_um = 1e6 * viscosity / 101_325 * math.sqrt(math.pi * 8.314462618 * kelvin / (2 * 0.028964))
        density = 101_325 * 0.028964 / (8.314462618 * kelvin)
        depth_um = 1e6 * math.sqrt(2 * viscosity / (density * 2 * math.pi * 2483.78))
        plate = 45_782 + 634 / 2 + 4_265 / 2
        return viscosity * (plate * (1 / (2.0033 + 2 * path_um) + 1 / depth_um) + 27_840 / (2.1 + 2 * path_um))

    for celsius, damping, quality in ((-40, 5.95, 5.81), (27, 7.09, 4.86), (85, 7.95, 4.33), (125, 8.48, 4.06)):
        stiffness, scale = scales(temperature_k=celsius + 273.15)
        assert scale == pytest.approx(sheared(celsius + 273.15) / sheared(300), rel=2e-3)
        assert scale * 7.09 == pytest.approx(damping, abs=0.01)
        assert math.sqrt(0.0538 * stiffness * 2.209e-10) / (scale * 7.09e-7) == pytest.approx(quality, abs=0.01)


def test_a_drawing_brings_its_own_film():
    drawn = parse({"device": {"id": "lcr-350", "geometry": {"film_gap_um": 0.2}}, "environment": {"pressure_pa": 1e4}})
    thin = Environment.scales(drawn.environment.params, drawn.context())[1]
    assert thin < scales(device="lcr-350", pressure_pa=1e4)[1]  # a thinner film is rarefied sooner


def test_stiction():
    kz = law.vertical_stiffness_n_m(0.0538, 2.0, 1.5233)
    assert kz == pytest.approx(0.0927, rel=2e-3)
    assert law.critical_adhesion_j_m2(kz, 2.0, 45888) == pytest.approx(4.0e-6, rel=0.02)
    assert law.critical_adhesion_j_m2(kz, 2.0, 100) == pytest.approx(1.85e-3, rel=0.01)
    assert 0.01e-3 <= law.adhesion_j_m2(0) <= 0.05e-3
    assert 10e-3 <= law.adhesion_j_m2(80) <= law.adhesion_j_m2(100) <= 100e-3
    # the dimples hold in dry air and give way in moist air
    assert law.adhesion_j_m2(20) < 1.85e-3 < law.adhesion_j_m2(80)


def test_ageing_ends_where_the_text_says():
    assert law.ageing_ratio(0.0) == 1.0
    assert law.ageing_ratio(4.0) == pytest.approx(0.572, abs=1e-12)
    assert 1 / law.ageing_ratio(4.0) == pytest.approx(1.748, rel=1e-3)
    # exponential: what two weeks take the next two take e times less often
    first, second = 1 - law.ageing_ratio(2.0), law.ageing_ratio(2.0) - law.ageing_ratio(4.0)
    assert second / first == pytest.approx(math.exp(-1), rel=1e-9)


@pytest.mark.parametrize(("omega", "effort"), [(1000.0, 1.751), (2900.0, 1.772)])
def test_ageing_and_more_mass_explain_the_almost_80_percent_of_case_1(omega, effort):
    si = device({"id": "ch3"}).resolved
    m, b, k = si["mass_kg"], si["damping_ns_m"], si["stiffness_n_m"]

    def stiff(mass, spring):
        return abs(complex(spring - mass * omega**2, b * omega))

    assert stiff(1.05 * m, k / law.ageing_ratio(4.0)) / stiff(m, k) == pytest.approx(effort, abs=1.5e-3)
    assert stiff(1.05 * m, k) / stiff(m, k) == pytest.approx(0.998, abs=3e-3)  # the mass alone


def test_squeeze_film_of_a_rarefied_gas():
    """Veijola et al. 1995: mu/(1 + 9.638 Kn^1.159); a thousand times rarer, nearly in proportion to the pressure."""
    for pressure, gap in ((101325.0, 2.1), (1e3, 2.1), (101325.0, 0.5)):
        mu = 1.716e-5 * (300 / 273.15) ** 1.5 * 383.55 / 410.4
        kn = mu / pressure * math.sqrt(math.pi * 1.380649e-23 * 300 / (2 * 4.81e-26)) * 1e6 / gap
        assert law.squeezed_share(pressure, 300.0, gap) == pytest.approx(1 / (1 + 9.638 * kn**1.159), rel=2e-3)
    assert law.squeezed_share(101325.0, 300.0, 1e4) == pytest.approx(1.0, abs=1e-4)
    assert law.squeezed_share(101325.0, 400.0, 1e4) == pytest.approx(
        law.viscosity(400.0) / law.viscosity(300.0), rel=1e-3
    )


def test_age_counts_in_the_figures_of_the_device():
    stiffness, damping = scales(age_weeks=4.0)
    assert stiffness == pytest.approx(1 / 0.572, rel=1e-9) and damping == 1.0


@pytest.mark.parametrize("name", ["gyro-a", "gyro-b", "gyro-c", "gyro-4-5"])
def test_a_sealed_gyroscope_feels_the_temperature_and_not_the_air_outside(name):
    """Young's modulus falls by 63 ppm/K, so the modes by half of that, and Q ~ sqrt(k)/d as well."""
    assert scales(device=name, pressure_pa=10.0, humidity_pct=90.0, friction_nn=50.0) == (1.0, 1.0)
    assert scales(device=name, pressure_pa=1e6, temperature_k=400.0) == (pytest.approx(1.0 - 63e-6 * 100.0), 1.0)
    assert scales(pressure_pa=10.0)[1] < 0.1, "a comb in air feels it"

    def figures(temperature):
        spec = parse({"device": {"id": name}, "environment": {"temperature_k": temperature, "pressure_pa": 5.0}})
        return device_metrics(spec)

    room, warm = figures(300.0), figures(400.0)
    softer = math.sqrt(1.0 - 6.3e-3)
    for mode in (1, 2):
        assert warm[f"gyro.mode_hz.{mode}"] / room[f"gyro.mode_hz.{mode}"] == pytest.approx(softer, rel=1e-5)
        ratio = warm[f"gyro.quality_factor.{mode}"] / room[f"gyro.quality_factor.{mode}"]
        assert ratio == pytest.approx(softer, rel=1e-5)
    # the floor goes with sqrt(T), over w
    floor = warm["gyro.floor_deg_per_h_rthz"] / room["gyro.floor_deg_per_h_rthz"]
    assert floor == pytest.approx(math.sqrt(4.0 / 3.0) / softer, rel=1e-9)


def test_only_a_leak_of_the_package_damps_a_gyroscope():
    """Its swing dies away alike in any air outside; with 100 Pa gained at 100 Pa, 1.8 times as fast."""

    def decay(pressure, leak=0.0):
        board = make(
            {
                "device.id": "gyro-c",
                "plant.thermal_noise": False,
                "plant.initial_x_um": 5.0,
                "environment.pressure_pa": pressure,
                "slots.drive": "forced_drive",
                "controllers.forced_drive.force_un": 0.0,
                "controller.kind": "open_loop_rate",
            },
            base=GYRO,
        )
        inject(board, package_leak=leak)
        energy = play(board, 5000)["plant.energy"]
        return math.log(energy[0] / energy[-1])

    assert decay(101325.0) == decay(10.0)
    assert decay(10.0, 100.0) / decay(10.0) == pytest.approx(1.8, rel=1e-3)
