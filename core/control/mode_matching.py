"""Mode matching: two pilot tones beside the carrier measure the split of the modes, the tuning voltage removes it."""

from __future__ import annotations

import math
from typing import Any

from core.block import Block, BlockParams, Context, Equation, Stage, parameter
from core.control.tuning_voltage import plates_of
from core.control.two_axis import TuningPorts, two_axis
from core.elementary import cos, sin, sin_of_turns
from core.kernel import kernel
from core.ports import output, reads, tap
from core.record import Record
from core.units import MS_PER_S


class ModeMatching(Block):
    r"""Brings y to the frequency of x by two pilot tones (Ezekwe and Boser 2008), and holds it there.

    A pilot force along y, :math:`P\cos\delta t\,\sin\theta`, has the frequencies :math:`\omega\pm\delta` beside the
    carrier. The answers are alike where y rings between them:

    .. math:: r=\frac{|Y_-|^2-|Y_+|^2}{|Y_-|^2+|Y_+|^2},\quad
        |D_\pm|^2=(a\mp2m\omega\delta)^2+d^2(\omega\pm\delta)^2,\quad a=k_{yy}-m\omega^2-m\delta^2

    so that

    .. math:: a=-\frac{2(rB-2\omega\delta d^2)}{4m\omega\delta+\sqrt{(4m\omega\delta)^2-4r(rB-2\omega\delta d^2)}},
        \quad B=4m^2\omega^2\delta^2+d^2(\omega^2+\delta^2) .

    The amplitudes alone count: neither a delay nor a gain of the loop changes the ratio. A rate or a quadrature is at
    the carrier, and does not enter. After every settling time the answers are measured over whole periods of
    :math:`\delta` with the window :math:`1-\cos`, and the voltage takes a step,

    .. math:: V^2\leftarrow V^2+\mu\,\frac{g^3}{2\varepsilon_0A}\left(k_{yy}-m\omega^2-m(2\omega+\Delta)\Delta\right)

    with the desired split :math:`\Delta`.
    """

    title = "Mode matching (pilot tones)"
    place = 22
    axes = ("x", "y")
    plants = ("tuned_gyroscope",)
    slot = "tuning"
    equations = (
        Equation("pilot", r"F_y=P\cos\delta t\,\sin\theta", "Ezekwe and Boser 2008"),
        Equation("ratio", r"r=\frac{|Y_-|^2-|Y_+|^2}{|Y_-|^2+|Y_+|^2}", "Ezekwe and Boser 2008"),
        Equation(
            "spring",
            r"a=-\frac{2c}{4m\omega\delta+\sqrt{(4m\omega\delta)^2-4rc}},\quad c=rB-2\omega\delta d^2",
        ),
        Equation(
            "tuning",
            r"V^2\leftarrow V^2+\mu\frac{g^3}{2\varepsilon_0A}\left(a+m\delta^2-m(2\omega+\Delta)\Delta\right)",
        ),
    )
    structure = (
        Stage("Pilot tones", "sine cosine frequency", "pilot", ("pilot",)),
        Stage("Answers", "y_measured sine cosine", "ratio", ("ratio",)),
        Stage("Split", "ratio frequency", "split softening", ("spring",)),
        Stage("Voltage", "split", "tuning", ("tuning",)),
    )
    weaknesses = (
        "A read-out that holds y at zero with a bandwidth near the pilot frequency takes the answers away.",
        "The open-loop read-out counts with the softening, and with correct_phase it reads the rate at matched modes. "
        "force_to_rebalance turns its force by the softening, and reads the rate whatever the split.",
        "The pilots are a ripple of the rate at the pilot frequency, which the low-pass of the read-out must remove.",
        "Beyond a split as large as the pilot frequency the measured split is too small, though of the right sign.",
    )

    class Params(BlockParams):
        """Pilot tones, times and gain."""

        pilot_hz: float = parameter(150.0, "distance of the pilot tones from the carrier", "Hz", gt=0, le=1e5)
        pilot_nm: float = parameter(5.0, "swing of y by the pilot tones at matched modes", "nm", gt=0, le=1e5)
        settle_ms: float = parameter(150.0, "wait after a step of the voltage", "ms", ge=0, le=1e6)
        measure_ms: float = parameter(100.0, "measuring time, in whole periods of the pilot", "ms", gt=0, le=1e6)
        gain: float = parameter(0.8, "share of the split that a step removes", "1", gt=0, le=1)
        split_hz: float = parameter(0.0, "desired split", "Hz", ge=-1e4, le=1e4)
        start_v: float = parameter(0.0, "voltage to begin with", "V", ge=0, le=1e4)
        most_share: float = parameter(0.9, "largest voltage, over the pull-in", "1", gt=0, le=0.99)

    class Packed(Record):
        """Pilot, times in samples, sense axis, plates."""

        half: float
        force: float
        period: float
        settle: float
        measure: float
        mass: float
        damping: float
        spring: float
        per_v2: float
        gain: float
        target: float
        most: float

    class State(Record):
        """Squared voltage, sample of the cycle, sums of the answers, the softening that is known."""

        square: float
        count: float
        sine_cosine: float
        sine_sine: float
        cosine_cosine: float
        cosine_sine: float
        known: float

    class Ports(TuningPorts):
        """Ports of the tuning slot; y and the carrier in, the split out."""

        y_measured: float = reads("sensor.y.displacement", "um", "measured displacement along y")
        sine: float = reads("@drive.sine", "1", "carrier in step with the displacement along x")
        cosine: float = reads("@drive.cosine", "1", "carrier in step with the velocity along x")
        frequency: float = reads("@drive.frequency", "Hz", "frequency of the carrier")
        applied: float = reads("@tuning.tuning", "V", "voltage of the controller that drives")
        split: float = output("Hz", "frequency of y less that of the carrier, as last measured")
        ratio: float = tap("1", "difference of the answers over their sum")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack pilot, sense axis and plates; the pilot has a whole number of samples."""
        device = two_axis(context)
        plates = plates_of(device)
        p = cls.Packed.blank()
        p.period = max(8.0, round(MS_PER_S / (params.pilot_hz * context.dt_ms)))
        p.settle = round(params.settle_ms / context.dt_ms)
        p.measure = p.period * max(3.0, round(params.measure_ms / (p.period * context.dt_ms)))
        p.half = 0.5 * context.dt_ms
        p.mass, p.damping = device.mass_y, device.damping_y
        omega, delta = device.drive_frequency, 2.0 * math.pi / (p.period * context.dt_ms)
        slow = math.sqrt(delta * delta + 0.25 * p.damping * p.damping / (p.mass * p.mass))
        p.force = 1e-3 * params.pilot_nm * 2.0 * p.mass * omega * slow
        p.spring = device.sense(omega).real
        p.per_v2 = plates.per_v2
        p.target = 2.0 * math.pi * params.split_hz / MS_PER_S
        limit = params.most_share * plates.pull_in_v(device.free_stiffness_y)
        p.most = limit * limit
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """At the voltage to begin with, as far as it is allowed."""
        s = cls.State.zeros()
        device = two_axis(context)
        plates = plates_of(device)
        limit = params.most_share * plates.pull_in_v(device.free_stiffness_y)
        volts = min(params.start_v, limit)
        s.square = volts * volts
        s.known = plates.per_v2 * s.square
        return s

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Sound the pilots, gather their answers, and step the voltage at the end of a cycle."""
        if x.tick == 0.0:
            x.split = 0.0
            x.ratio = 0.0
        if x.engaged == 0.0:
            s.square = x.applied * x.applied
            s.known = p.per_v2 * s.square
            begin(s)
        omega = 2.0 * math.pi * x.frequency / MS_PER_S
        turns = (s.count - p.settle) / p.period
        near, far = sin_of_turns(turns + 0.25), sin_of_turns(turns)
        late = omega * p.half
        x.pilot = p.force * near * (x.sine * cos(late) + x.cosine * sin(late)) if x.engaged != 0.0 else 0.0
        if s.count >= p.settle:
            weight = 1.0 - sin_of_turns((s.count - p.settle) / p.measure + 0.25)
            along, across = weight * x.y_measured * x.sine, weight * x.y_measured * x.cosine
            s.sine_cosine += along * near
            s.sine_sine += along * far
            s.cosine_cosine += across * near
            s.cosine_sine += across * far
        s.count += 1.0
        if s.count >= p.settle + p.measure:
            answer(p, s, x, omega)
            begin(s)
        x.tuning = math.sqrt(s.square)
        x.softening = s.known


@kernel
def begin(s: ModeMatching.State) -> None:
    """Begin a cycle."""
    s.count = 0.0
    s.sine_cosine = 0.0
    s.sine_sine = 0.0
    s.cosine_cosine = 0.0
    s.cosine_sine = 0.0


@kernel
def held(omega: float, half: float) -> float:
    """Return the power of a held tone over the power of a continuous one; 1 for no frequency."""
    share = omega * half
    return (sin(share) / share) * (sin(share) / share) if share != 0.0 else 1.0


@kernel
def answer(p: ModeMatching.Packed, s: ModeMatching.State, x: ModeMatching.Ports, omega: float) -> None:
    """Compare the answers above and below the carrier, and take the step of the voltage."""
    u, v = s.sine_cosine + s.cosine_sine, s.cosine_cosine - s.sine_sine
    above = u * u + v * v
    u, v = s.sine_cosine - s.cosine_sine, s.cosine_cosine + s.sine_sine
    below = u * u + v * v
    delta = math.pi / (p.half * p.period)
    above /= held(omega + delta, p.half)
    below /= held(omega - delta, p.half)
    both = above + below
    if both > 0.0 and omega > delta:
        r = (below - above) / both
        cross = 4.0 * p.mass * omega * delta
        square = p.damping * p.damping
        size = 0.25 * cross * cross + square * (omega * omega + delta * delta)
        rest = r * size - 2.0 * omega * delta * square
        a = -2.0 * rest / (cross + math.sqrt(max(cross * cross - 4.0 * r * rest, 0.0)))
        left = a + p.mass * delta * delta
        x.ratio = r
        x.split = MS_PER_S * (math.sqrt(max(omega * omega + left / p.mass, 0.0)) - omega) / (2.0 * math.pi)
        before = s.square
        wanted = left - p.mass * (2.0 * omega + p.target) * p.target
        s.square = min(max(before + p.gain * wanted / p.per_v2, 0.0), p.most)
        s.known = p.spring - left + p.per_v2 * (s.square - before)
