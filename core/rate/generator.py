"""Base of the generators of angular rate: ports, noise, and the step that plays a shape."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar

from core.block import Block, Context, Equation
from core.ports import BlockPorts, output, tap
from core.rate.drift import Drift, DriftParams, PackedDrift, drift_now, pack_drift, start_drift
from core.record import Record

NOISE = Equation(
    "noise",
    r"\sigma^2(\tau)=\frac{N^2}{\tau}+\frac{2\ln2}{\pi}B^2+\frac{K^2\tau}{3}",
    "IEEE Std 952, annex C",
)
"""Allan variance of the noise that every generator may add."""


class RateGenerator(Block):
    """A generator of angular rate; a subclass gives ``shape(p, t_ms)`` in deg/s."""

    axes: ClassVar[tuple[str, ...]] = ("x", "y")

    weaknesses = (
        "The Allan deviation of the bias instability is flat within 4.5 % from 0.01 s to 10000 s at 10 kHz and above; "
        "a slower bench begins at 100 of its samples.",
    )

    Params = DriftParams

    class Packed(Record):
        """Every generator: ms of a tick, and the noise."""

        tick_ms: float
        drift: PackedDrift

    class State(Record):
        """The noise."""

        drift: Drift

    class Ports(BlockPorts):
        """The angular rate."""

        rate: float = output("deg/s", "angular rate of the device, noise included")
        commanded: float = tap("deg/s", "angular rate without its noise")

    def __init_subclass__(cls) -> None:
        """Make the step play the shape of the subclass."""
        super().__init_subclass__()
        cls.step = playing(cls.shape)  # type: ignore[assignment]

    @classmethod
    def pack(cls, params: Any, context: Context) -> Any:
        """Pack the tick and the noise; a generator that runs every N ticks is held between them."""
        p = cls.Packed.blank(cls.tails(params))
        p.tick_ms = context.dt_ms / context.every
        pack_drift(p.drift, params, context)
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> Any:
        """Begin the noise."""
        s = cls.State.zeros()
        start_drift(s.drift, context)
        return s

    @classmethod
    def tails(cls, params: Any) -> int:
        """Return the length of the packed record's tail."""
        return 0

    @staticmethod
    def shape(p: Any, t: float) -> float:
        """Return the rate without noise, deg/s, at a time in ms."""
        raise NotImplementedError


def playing(shape: Callable[[Any, float], float]) -> Callable[[Any, Any, Any], None]:
    """Return the step that plays ``shape`` with noise added."""

    def step(p: RateGenerator.Packed, s: RateGenerator.State, x: RateGenerator.Ports) -> None:
        commanded = shape(p, x.tick * p.tick_ms)
        x.commanded = commanded
        x.rate = commanded + drift_now(p.drift, s.drift, x.tick)

    return step
