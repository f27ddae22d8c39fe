"""The stages of a board around its converters: closed forms, nothing left where they are off, tuned while it runs."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
import pytest

from core.board.board import Board
from core.board.ensemble import Ensemble
from core.board.hosted import Hosted
from core.board.parse import parse
from core.errors import InputError
from core.lag import moments_of_decay
from scenarios.campaign.batch import outcomes, shape
from scenarios.schema import Scenario
from tests.lab import AXES_RICH, QUIET, RICH, do, document, inner_digest, make, phasor, play, rms, run_digest
from tests.scenarios import ways

DT_MS = 0.01
SETTLED = 4000
HELD: dict[str, Any] = {"reference.frequency_hz": 2000.0}
ANALOGUE: dict[str, Any] = {**HELD, "drive.kind": "analogue"}
GYROSCOPE: dict[str, Any] = {
    "sample_rate_khz": 100,
    "device": {"id": "gyro-a"},
    "plant": {"model": "gyroscope", "thermal_noise": False},
    "slots": {"drive": "forced_drive"},
    "controller": {"kind": "open_loop_rate"},
    "sensor": {"kind": "pick_off"},
}
OWN_SENSOR = '''
from core.ports import BlockPorts, reads
from core.record import Record
from core.sense.sensor import ERROR_PORT, RECOVERED_PORT, TRUE_PORT, Sensor, SensorParams


class Mine(Sensor):
    """A sensor of one's own."""

    title = "Mine"

    class Params(SensorParams):
        """Nothing to choose."""

    class Ports(BlockPorts):
        """The displacement it senses, and the true one."""

        sensed: float = reads("plant.displacement", "um", "displacement")
        true: float = TRUE_PORT
        displacement: float = RECOVERED_PORT
        error: float = ERROR_PORT

    @staticmethod
    def step(p: Record, s: Record, x: Ports) -> None:
        """Sense the displacement."""
        x.displacement = x.sensed
        x.error = x.sensed - x.true
'''
ALL = {
    "board.delay_samples": 1,
    "board.delay_fraction": 0.3,
    "board.amplifier_khz": 80.0,
    "board.slew_v_per_us": 0.05,
    "board.antialias_khz": 60.0,
    "board.jitter_us": 0.1,
}


def ratio(stage: dict[str, Any], signal: str, base: dict[str, Any], hz: float) -> complex:
    """Return the response with a stage over the response without it, at a tone in the steady state."""
    with_it, without = (
        phasor(play(make({**base, **values}), 6000)[signal][SETTLED:], hz, DT_MS, SETTLED) for values in (stage, {})
    )
    return with_it / without


# -- closed forms


@pytest.mark.parametrize("drive", [HELD, ANALOGUE], ids=["held", "analogue"])
@pytest.mark.parametrize(("samples", "fraction"), [(3, 0.0), (0, 0.37), (2, 0.5)])
def test_a_delay_turns_the_phase_by_frequency_times_delay(drive, samples, fraction):
    stage = {"board.delay_samples": samples, "board.delay_fraction": fraction}
    found = ratio(stage, "plant.displacement", drive, 2000.0)
    assert cmath.phase(found) == pytest.approx(-2.0 * math.pi * 2.0 * DT_MS * (samples + fraction), rel=1e-3)
    assert abs(found) == pytest.approx(1.0, abs=1e-4)


def test_a_delay_turns_the_phase_of_an_axis():
    base = document({"board.delay_fraction": 0.0}, GYROSCOPE)
    hz = 500.0
    force = {"controllers.forced_drive.force_un": 1.0, "controllers.forced_drive.frequency_hz": hz}
    found = [
        phasor(play(make({**force, "board.delay_fraction": share}, base=base), 30000)["plant.x"][24000:], hz, DT_MS)
        for share in (0.0, 0.5)
    ]
    assert cmath.phase(found[1] / found[0]) == pytest.approx(-2.0 * math.pi * 0.5 * DT_MS * 0.5, rel=0.01)


@pytest.mark.parametrize(("samples", "fraction"), [(8, 0.0), (8, 0.5)])
def test_a_delay_takes_crossover_times_delay_off_the_phase_margin(samples, fraction):
    """A gain around an integrator has a margin of 90 degrees less its crossover times all delay, the hold included."""
    edge = 0.5 * math.pi / ((samples + fraction + 0.5) * DT_MS)
    sizes = {}
    for share in (0.99, 1.01):
        values = {
            "device": {"transfer_function": {"denominator": [1.0, 0.0], "time_unit_ms": 1.0}},
            "plant": {"model": "transfer_function", "initial_displacement_um": 1e-3},
            "board": {"delay_samples": samples, "delay_fraction": fraction},
        }
        bench = {**QUIET, **values}
        board = Hosted(parse(bench), lambda x, gain=share * edge: -gain * x.measured)
        x = play(board, 4000)["plant.displacement"]
        sizes[share] = np.abs(x[3900:]).max() / np.abs(x[1900:2000]).max()
    assert sizes[0.99] < 0.9 < 1.1 < sizes[1.01]


@pytest.mark.parametrize("drive", [HELD, ANALOGUE], ids=["held", "analogue"])
@pytest.mark.parametrize("corner", [1.0, 5.0, 20.0])
def test_an_amplifier_is_a_lag_of_the_first_order(drive, corner):
    found = ratio({"board.amplifier_khz": corner}, "plant.displacement", drive, 2000.0)
    expected = 1.0 / (1.0 + 2.0j / corner)
    assert abs(found / expected - 1.0) < 1e-3


def test_an_amplifier_far_faster_than_a_sample_delays_by_its_time_constant():
    found = ratio({"board.amplifier_khz": 300.0}, "plant.displacement", HELD, 2000.0)
    assert cmath.phase(found) == pytest.approx(-2.0 / 300.0, rel=0.01)


def test_a_sine_beyond_the_slew_becomes_a_triangle():
    slew = 0.02
    found = 10.0 * abs(ratio({"board.slew_v_per_us": slew}, "plant.displacement", HELD, 2000.0))
    assert found == pytest.approx(8.0 / math.pi**2 * slew * 1e6 / (4.0 * 2000.0), rel=0.01)


def test_a_step_rises_by_the_slew_and_ends_by_the_bandwidth():
    values = {"reference": {"kind": "step", "amplitude_v": 10.0, "start_ms": 0.02}}
    stage = {"board.slew_v_per_us": 0.1, "board.amplifier_khz": 10.0}
    board = make({**values, **stage})
    arrived = []
    for _ in range(60):
        board.advance(1)
        arrived.append(float(board.wiring.state("amplifier").arrived))
    constant = 1e3 / (2.0 * math.pi * 10.0)
    turn = (10.0 - 0.1 * constant) / 0.1
    time = 10.0 * np.arange(1, 59)
    expected = np.where(time < turn, 0.1 * time, 10.0 - 0.1 * constant * np.exp(-(time - turn) / constant))
    assert np.abs(np.array(arrived[2:]) - expected).max() < 1e-9
    assert board.value("drive.voltage") == 10.0


@pytest.mark.parametrize("corner", [0.0, 20.0, 300.0])
@pytest.mark.parametrize("slew", [0.0, 0.3])
def test_the_device_is_given_mean_slope_and_bend_of_the_voltage_over_each_tick(corner, slew):
    """Against small steps of the equation, with a command that jumps at random."""
    stage = {"delay_samples": 1, "delay_fraction": 0.3, "amplifier_khz": corner, "slew_v_per_us": slew}
    reference = {"kind": "prbs", "amplitude_v": 5.0, "chip_rate_hz": 50000.0}
    board = make({"board": stage, "reference": reference})
    commands, parabolas = [], []
    for _ in range(15):
        board.advance(1)
        commands.append(board.value("drive.voltage"))
        parabolas.append([board.value(f"amplifier.{name}") for name in ("voltage", "middle", "end")])
    parts = 20000
    share = (np.arange(parts) + 0.5) / parts
    asked = [0.0, 0.0, *commands]
    voltage, past = 0.0, np.empty(parts)
    pole, most = 2.0 * math.pi * corner * DT_MS / parts, slew * 1e3 * DT_MS / parts if slew else math.inf
    for tick, found in enumerate(parabolas):
        for k in range(parts):
            gap = asked[tick + (1 if share[k] > 0.3 else 0)] - voltage
            step = gap * -math.expm1(-pole) if corner else gap
            before, voltage = voltage, voltage + min(max(step, -most), most)
            past[k] = 0.5 * (before + voltage) if corner or slew else voltage
        parabola = np.polyval(np.polyfit([0.0, 0.5, 1.0], found, 2), share)
        for weight in (1.0, 2.0 * share - 1.0, 6.0 * share * share - 6.0 * share + 1.0):
            assert np.mean(weight * parabola) == pytest.approx(np.mean(weight * past), abs=2e-3)


def test_noise_of_jitter_is_slope_times_jitter():
    trace = play(make({**HELD, "board.jitter_us": 0.2}), 40000)
    noise = (trace["sensor.displacement"] - trace["plant.displacement"])[SETTLED:]
    assert rms(noise) == pytest.approx(0.2e-3 * rms(trace["plant.velocity"][SETTLED:]), rel=0.01)


def test_all_axes_are_sampled_by_one_clock():
    along = document({"board.jitter_us": 0.2, "plant.initial_x_um": 1.0, "plant.initial_y_um": 0.5}, GYROSCOPE)
    trace = play(make(base=along), 40000)
    late = []
    for axis in ("x", "y"):
        place, velocity = trace[f"plant.{axis}"], trace[f"plant.{axis}_velocity"]
        late.append((trace[f"sensor.{axis}.displacement"] - place)[1:] / velocity[1:])
        late.append((trace[f"sensor.{axis}.velocity"] - velocity)[1:] / (np.diff(velocity) / DT_MS))
    assert rms(late[0]) == pytest.approx(0.2e-3, rel=0.01)
    for other in late[1:]:
        assert np.median(np.abs(other / late[0] - 1.0)) < 1e-9


def test_a_tone_beyond_half_the_rate_of_a_sensor_folds_back_as_the_filter_leaves_it():
    values = {"reference.frequency_hz": 20000.0, "drive.kind": "analogue", "sensor.every": 4}
    for corner, share in ((0.0, 1.0), (10.0, 1.0 / math.sqrt(5.0))):
        trace = play(make({**values, "board.antialias_khz": corner}), 8000)
        tone = phasor(trace["plant.displacement"][SETTLED:], 20000.0, DT_MS)
        alias = phasor(trace["sensor.displacement"][SETTLED::4], 5000.0, 4.0 * DT_MS)
        assert abs(alias) == pytest.approx(share * abs(tone), rel=0.01)


@pytest.mark.parametrize("hz", [200.0, 2000.0, 10000.0])
def test_an_anti_alias_filter_is_a_lag_of_the_first_order(hz):
    trace = play(make({"reference.frequency_hz": hz, "board.antialias_khz": 10.0}), 8000)
    sensed, true = (phasor(trace[f"{name}.displacement"][SETTLED:], hz, DT_MS) for name in ("sensor", "plant"))
    assert abs(sensed / true * (1.0 + 1e-4j * hz) - 1.0) < 1e-3


def test_moments_of_a_decay_meet_where_the_two_ways_change():
    for z in (1e-9, 0.3, 1.0 - 1e-12, 1.0, 40.0):
        nodes, weights = np.polynomial.legendre.leggauss(60)
        a = 0.5 * (nodes + 1.0)
        exact = [float(0.5 * np.sum(weights * a**k * np.exp(-z * a))) for k in range(4)]
        assert np.allclose(moments_of_decay(z), [*exact, math.exp(-z)], rtol=1e-11, atol=0.0)


# -- order and spelling


def test_a_measurement_is_rounded_behind_the_filter_and_a_command_before_the_delay():
    stage = {"board.antialias_khz": 5.0, "sensor.quantum_um": 0.5, "drive.quantum_v": 1.0, "board.delay_samples": 1}
    trace = play(make({**HELD, **stage}), 600)
    assert np.all(trace["sensor.displacement"] % 0.5 == 0.0)
    assert np.array_equal(trace["drive.voltage"], np.floor(trace["open_loop.voltage"] + 0.5))


def test_a_unit_senses_the_filtered_motion_and_its_error_is_against_the_true_one():
    stage = {**HELD, "board.antialias_khz": 5.0}
    own = play(make({**stage, "units.mine.source": OWN_SENSOR, "sensor.kind": "mine"}), 300)
    ideal = play(make(stage), 300)
    assert own["sensor.displacement"].tobytes() == ideal["sensor.displacement"].tobytes()
    assert np.array_equal(own["mine.error"], own["sensor.displacement"] - own["plant.displacement"])
    assert rms(own["mine.error"]) > 0.1


def test_bits_are_another_spelling_of_a_step():
    by_bits, by_step = (
        {"drive.bits": 12, "sensor.bits": 10},
        {"drive.quantum_v": 60 / 4096, "sensor.quantum_um": 80 / 1024},
    )
    digests = [run_digest(make({**HELD, **values}), 400) for values in (by_bits, by_step, {})]
    assert digests[0] == digests[1] != digests[2]
    assert run_digest(make({"drive.bits": 9}, base=AXES_RICH), 200) == run_digest(
        make({"drive.quantum_un": 2000 / 512}, base=AXES_RICH), 200
    )


@pytest.mark.parametrize(
    ("table", "steps"),
    [("drive", {"bits": 8, "quantum_v": 0.1}), ("sensor", {"kind": "ideal", "bits": 8, "quantum_um": 0.1})],
)
def test_both_spellings_at_once_are_refused(table, steps):
    with pytest.raises(InputError, match="does too") as told:
        parse({**QUIET, table: steps})
    assert told.value.field == f"{table}.bits"


def test_one_spelling_that_is_set_drops_the_other():
    board = make({}, base=RICH)
    do(board, {"set": {"drive.bits": 8, "sensor.bits": 9}})
    drive, ideal = board.spec.drive.params, board.spec.sensors["ideal"].params
    assert (drive.bits, drive.quantum_v, ideal.bits, ideal.quantum_um) == (8, 0.0, 9, 0.0)
    do(board, {"set": {"drive.quantum_v": 0.5, "drive.bits": 0, "sensors.ideal.quantum_um": 0.1}})
    drive, ideal = board.spec.drive.params, board.spec.sensors["ideal"].params
    assert (drive.bits, drive.quantum_v, ideal.bits, ideal.quantum_um) == (0, 0.5, 0, 0.1)
    assert RICH["drive"] == {"quantum_v": 0.005} and RICH["sensor"]["quantum_um"] == 0.001


def test_a_drive_of_forces_has_no_slew_in_volts():
    with pytest.raises(InputError, match="unknown field") as told:
        make({"board.slew_v_per_us": 1.0}, base=AXES_RICH)
    assert told.value.field == "board.slew_v_per_us"


# -- off and on


@pytest.mark.parametrize("base", [RICH, AXES_RICH], ids=["x", "x and y"])
def test_a_stage_that_is_off_is_left_out(base):
    plain = make({}, base=base)
    zeros = {path: 0 for path in ALL if base is RICH or path != "board.slew_v_per_us"}
    off = make(zeros, base=base)
    assert [one.key for one in off.wiring.instances] == [one.key for one in plain.wiring.instances]
    assert run_digest(off, 200) == run_digest(plain, 200)
    assert inner_digest(off) == inner_digest(plain)


def test_stages_come_and_go_while_the_board_runs():
    commands = [
        {"set": {"board.delay_samples": 2, "board.jitter_us": 0.1}, "at_sample": 50},
        {"set": {"board.amplifier_khz": 40.0, "board.antialias_khz": 40.0}, "at_sample": 90},
        {"set": {"board.delay_samples": 0, "board.amplifier_khz": 0.0}, "at_sample": 150},
        {"set": {"board.jitter_us": 0.0, "board.antialias_khz": 0.0}, "at_sample": 190},
        {"fault": "added_mass", "severity": 0.05, "at_sample": 120},
    ]
    fast, slow = make({}, commands, base=RICH), make({}, commands, base=RICH, compiled=False)
    rows = len(fast.wiring.instances)
    fast.advance(100)
    assert len(fast.wiring.instances) == rows + 2
    fork = Board.restore(fast.checkpoint())
    for board in (fast, fork):
        play(board, 200)
    assert run_digest(slow, 300) == fast.digest() == fork.digest()
    assert inner_digest(slow) == inner_digest(fast) == inner_digest(fork)
    assert len(fast.wiring.instances) == rows
    kept = fast.save()
    again = make({}, kept["events"], base={key: kept[key] for key in kept if key not in ("events", "samples")})
    assert run_digest(again, 300) == fast.digest()


def test_a_delay_that_comes_finds_the_command_where_it_was():
    board = make({"reference": {"kind": "constant", "amplitude_v": 5.0}})
    play(board, 100)
    before = board.value("plant.displacement")
    do(board, {"set": {"board.delay_samples": 20, "board.amplifier_khz": 5.0}})
    plain = make({"reference": {"kind": "constant", "amplitude_v": 5.0}})
    play(plain, 100)
    assert plain.value("plant.displacement") == before
    assert play(board, 100)["plant.displacement"].tobytes() == play(plain, 100)["plant.displacement"].tobytes()


def test_a_trip_takes_off_the_voltage_that_has_arrived():
    board = make({"board.delay_samples": 3, "guard.travel_um": 0.5})
    play(board, 2000)
    assert board.trip is not None
    assert [board.value(f"amplifier.{name}") for name in ("voltage", "middle", "end")] == [0.0, 0.0, 0.0]


def test_a_twin_may_have_stages_of_its_own():
    twin = {"late": {"board": {"delay_samples": 2}}}
    board = Ensemble({**document(HELD), "twins": twin})
    trace = play(board, 300)
    late = play(make({**HELD, "board.delay_samples": 2}), 300)
    assert trace["late:plant.displacement"].tobytes() == late["plant.displacement"].tobytes()
    assert trace["plant.displacement"].tobytes() != late["plant.displacement"].tobytes()


@pytest.mark.parametrize("base", [RICH, AXES_RICH], ids=["x", "x and y"])
def test_runs_with_other_delays_go_abreast_with_the_bits_of_each_alone(base):
    axes = base is AXES_RICH
    own = {path: value for path, value in ALL.items() if not (axes and path == "board.slew_v_per_us")}
    documents = [
        {**document({**own, "board.delay_samples": lane, "board.delay_fraction": 0.2 * lane, "seed": lane + 1}, base)}
        for lane in range(4)
    ]
    scenarios = [Scenario.load({"samples": 300, **one}) for one in documents]
    found = outcomes([(scenario, scenario.spec.seed) for scenario in scenarios])
    assert {shape(scenario) for scenario in scenarios} == {shape(scenarios[0])} != {None}
    assert shape(Scenario.load({"samples": 300, **base})) != shape(scenarios[0])
    assert [one.digest for one in found] == [run_digest(make({}, base=one), 300) for one in documents]


def test_a_name_of_a_stage_is_taken():
    bank = RICH["diagnosers"]["kalman"]
    with pytest.raises(InputError, match="part of the bench"):
        parse({**QUIET, "diagnosers": {"amplifier": bank}})


@pytest.mark.parametrize("base", [QUIET, AXES_RICH], ids=["x", "x and y"])
def test_stages_are_the_same_behind_the_wall(base):
    own = {path: value for path, value in ALL.items() if not (base is AXES_RICH and path == "board.slew_v_per_us")}
    scenario = {**document(own, base), "samples": 60}
    assert ways.result(scenario, ways.WALL) == ways.result(scenario, ways.ALONE)
