"""Amplifier: computation delay, bandwidth and slew between the converter of the drive and the device."""

from __future__ import annotations

import math
from typing import Any

from core.block import Block, BlockParams, Context, Equation, parameter
from core.kernel import flush_tiny, kernel
from core.lag import moments_of_decay
from core.ports import BlockPorts, output, reads
from core.record import Record, Records, several

MOST_DELAY = 64
KEPT = MOST_DELAY + 2
"""Commands kept: the latest, the most delayed, and the command before it."""
PARTS = 8
"""Parts of a tick; an analogue command counts in each with its value in the middle."""


class DelayParams(BlockParams):
    """The stages behind the converter of the drive."""

    delay_samples: int = parameter(0, "samples from the measurement to the voltage", ge=0, le=MOST_DELAY)
    delay_fraction: float = parameter(0.0, "share of a sample in addition", ge=0, le=1)
    amplifier_khz: float = parameter(0.0, "bandwidth of the amplifier, 0 for no limit", "kHz", ge=0, le=1e5)


class Command(Record):
    """The command over a tick: at its start, in its middle and at its end."""

    start: float
    middle: float
    end: float


class PackedAmplifier(Record):
    """Delay in whole samples and share of one, bandwidth and slew per tick."""

    samples: float
    fraction: float
    per_tick: float
    slew: float


class AmplifierState(Record):
    """Whether it has run, its output, the moments of the output over the tick, the last commands."""

    begun: float
    arrived: float
    moment0: float
    moment1: float
    moment2: float
    past: Records[Command] = several(KEPT)


@kernel
def gather_line(s: AmplifierState, begin: float, length: float, start: float, rise: float) -> None:
    """Add to the moments a stretch of the tick over which the output moves on a line."""
    square = length * length
    own0 = start * length + 0.5 * rise * square
    own1 = 0.5 * start * square + rise * square * length / 3.0
    own2 = start * square * length / 3.0 + 0.25 * rise * square * square
    s.moment0 += own0
    s.moment1 += begin * own0 + own1
    s.moment2 += begin * (begin * own0 + 2.0 * own1) + own2


@kernel
def follow(p: PackedAmplifier, s: AmplifierState, u: float, begin: float, length: float) -> None:
    """Let the output follow a held command over a stretch of the tick: at full slew first, then by its bandwidth."""
    near = p.slew / p.per_tick if p.per_tick > 0.0 else 0.0
    gap = u - s.arrived
    if p.slew > 0.0 and abs(gap) > near:
        rise = p.slew if gap > 0.0 else -p.slew
        time = min((abs(gap) - near) / p.slew, length)
        gather_line(s, begin, time, s.arrived, rise)
        s.arrived += rise * time
        begin += time
        length -= time
        gap = u - s.arrived
    if length > 0.0:
        gather_line(s, begin, length, u, 0.0)
        left = 0.0
        if p.per_tick > 0.0:
            z = p.per_tick * length
            first, second, third, _, rest = moments_of_decay(z)
            own0 = -gap * length * first
            own1 = -gap * length * length * second
            own2 = -gap * length * length * length * third
            s.moment0 += own0
            s.moment1 += begin * own0 + own1
            s.moment2 += begin * (begin * own0 + 2.0 * own1) + own2
            left = flush_tiny(gap * rest)
        s.arrived = u - left


@kernel
def follow_part(
    p: PackedAmplifier, s: AmplifierState, command: Command, first: float, begin: float, length: float
) -> None:
    """Let the output follow a command from the share ``first`` of its tick on, over a stretch of this tick."""
    if length > 0.0:
        if command.middle == command.start and command.end == command.start:
            follow(p, s, command.start, begin, length)
        else:
            middle = command.middle - command.start
            end = command.end - command.start
            part = length / PARTS
            for k in range(PARTS):
                a = first + (k + 0.5) * part
                u = command.start + a * (4.0 * middle - end + a * (2.0 * end - 4.0 * middle))
                follow(p, s, u, begin + k * part, part)


@kernel
def pass_on(
    p: PackedAmplifier, s: AmplifierState, tick: float, start: float, middle: float, end: float
) -> tuple[float, float, float]:
    r"""Return the output at the start, in the middle and at the end of a parabola with its moments over the tick.

    The parabola is the projection on Legendre polynomials: the output less the parabola has no mean, no slope and no
    bend, so a device moves alike to the order :math:`(\omega h)^3`.
    """
    if s.begun == 0.0:
        s.begun = 1.0
        if tick > 0.0:  # it comes while the board runs: so far the command has arrived at once
            s.arrived = start
            for k in range(KEPT):
                s.past[k].start, s.past[k].middle, s.past[k].end = start, start, start
    latest = s.past[int(tick) % KEPT]
    latest.start, latest.middle, latest.end = start, middle, end
    now = s.past[int(tick + KEPT - p.samples) % KEPT]
    before = s.past[int(tick + KEPT - p.samples - 1.0) % KEPT]
    if p.per_tick == 0.0 and p.slew == 0.0 and p.fraction == 0.0:
        s.arrived = now.end
        return now.start, now.middle, now.end
    s.moment0, s.moment1, s.moment2 = 0.0, 0.0, 0.0
    u = s.arrived
    is_still = u == now.start and u == now.middle and u == now.end
    if is_still and (p.fraction == 0.0 or (u == before.start and u == before.middle and u == before.end)):
        return u, u, u
    follow_part(p, s, before, 1.0 - p.fraction, 0.0, p.fraction)
    follow_part(p, s, now, 0.0, p.fraction, 1.0 - p.fraction)
    slope = 3.0 * (2.0 * s.moment1 - s.moment0)
    bend = 5.0 * (6.0 * (s.moment2 - s.moment1) + s.moment0)
    return s.moment0 - slope + bend, s.moment0 - 0.5 * bend, s.moment0 + slope + bend


def packed_amplifier(p: Any, params: Any, context: Context, slew: float) -> Any:
    """Pack the delay and the bandwidth, and the slew in units of the drive per ms."""
    p.samples, p.fraction = float(params.delay_samples), params.delay_fraction
    p.per_tick, p.slew = 2.0 * math.pi * params.amplifier_khz * context.dt_ms, slew * context.dt_ms
    return p


class Amplifier(Block):
    r"""Delay, bandwidth and slew: the voltage that the board asks for arrives at the device late.

    The delay is the time that the board takes to compute. It is in front of limiter and converter of the drive, which
    have no memory: they commute with it, and one block can have all of the lateness. The amplifier has one pole,
    :math:`\dot v=\omega_a(u-v)`, and no more than a slew. Controllers, identifiers and diagnosers know the command
    ``drive.voltage`` alone, as on a real board. A stage of 0 passes on the command as it is; the block is left out when
    all are 0.
    """

    title = "Delay and amplifier"
    equations = (
        Equation("delay", r"u(t)=u_c(t-(d+f)\,h)"),
        Equation("amplifier", r"\dot v=\max\left(-S,\min\left(S,\;\omega_a\,(u-v)\right)\right)"),
    )

    class Params(DelayParams):
        """The stages behind the converter of the drive."""

        slew_v_per_us: float = parameter(0.0, "slew of the amplifier, 0 for no limit", "V/us", ge=0, le=1e6)

    class Packed(PackedAmplifier):
        """Delay, bandwidth and slew."""

    class State(AmplifierState):
        """The output and the last commands."""

    class Ports(BlockPorts):
        """The command, and the voltage that arrives, as a parabola over the tick."""

        command: float = reads("drive.voltage", "V", "voltage of the converter")
        command_middle: float = reads("drive.middle", "V", "the same half a sample later")
        command_end: float = reads("drive.end", "V", "the same one sample later")
        voltage: float = output("V", "voltage that arrives", hidden=True)
        middle: float = output("V", "the same half a sample later", hidden=True)
        end: float = output("V", "the same one sample later", hidden=True)

    @classmethod
    def rests(cls, params: Any) -> bool:
        """Say whether the command arrives as it is."""
        return not (params.delay_samples or params.delay_fraction or params.amplifier_khz or params.slew_v_per_us)

    @classmethod
    def pack(cls, params: Any, context: Context) -> PackedAmplifier:
        """Pack the stages; V/us are 1000 V/ms."""
        found: PackedAmplifier = packed_amplifier(cls.Packed.blank(), params, context, 1e3 * params.slew_v_per_us)
        return found

    @staticmethod
    def step(p: PackedAmplifier, s: AmplifierState, x: Ports) -> None:
        """Let the command arrive."""
        x.voltage, x.middle, x.end = pass_on(p, s, x.tick, x.command, x.command_middle, x.command_end)
