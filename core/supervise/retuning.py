"""The model of the controller, set to the weighted estimate of a bank."""

from __future__ import annotations

import math
from typing import Any, Literal

from core.block import Context, Equation, Stage, parameter
from core.control.nominal import RATIOS
from core.diagnose.lanes import LANE
from core.elementary import exp
from core.format import format_short
from core.kernel import flush_tiny
from core.ports import output, reads, tap
from core.record import Record, Vector, vector
from core.supervise.supervisor import Act, Supervisor, SupervisorPorts, Value
from core.supervise.verdict import WaitingPacked, WaitingParams, hypotheses, take_waiting, ticks

DIGITS = 4
"""Decimals of a factor that is set."""
PARTS = tuple(name.removesuffix("_ratio") for name in RATIOS)


class Retuning(Supervisor):
    r"""Sets the device that a controller knows to the weighted estimate, :math:`\hat\theta=\sum_i\bar p_i\theta_i`.

    The weights pass a lag of a quarter of the hold time. Once a factor of the estimate has differed from the value set
    last by more than ``least_change`` for the hold time, the estimate is set. An estimate is always within the range of
    the hypotheses, so it falls short for a device outside this range.
    """

    title = "Retune the model"
    place = 3
    equations = (
        Equation(
            "estimate",
            r"\hat\theta=\sum_i\bar p_i\theta_i,\quad \tfrac14T_{hold}\dot{\bar p}_i=p_i-\bar p_i",
            "5.2.3.2",
        ),
        Equation("request", r"\max_j|\hat\theta_j-\theta_j^{set}|>\epsilon\ \text{for}\ T_{hold}"),
    )
    structure = (
        Stage("Weighted estimate", "probability", "estimate", ("estimate",)),
        Stage("Request", "estimate winner unexplained", "request difference dead_ms", ("request",)),
    )
    weaknesses = (
        "The weights of a bank gather on the nearest hypothesis, so between two hypotheses the estimate is most often "
        "one of them.",
    )

    class Params(WaitingParams):
        """The controller, and when its model is set."""

        controller: str = parameter("lqg", "controller whose model is set")
        least_change: float = parameter(0.02, "change of a factor that is worth a request", gt=0, le=1)
        on_unknown: Literal["hold", "follow", "safe"] = parameter(
            "follow",
            "act while no hypothesis fits: hold sets nothing, follow sets the estimate all the same, safe trips",
        )

    class Packed(WaitingPacked):
        """In addition the share of a weight kept from tick to tick, the least change, and what unknown means."""

        keep: float
        least_change: float
        holds: float
        trips: float
        mass: Vector = vector(LANE)
        stiffness: Vector = vector(LANE)
        damping: Vector = vector(LANE)
        gain: Vector = vector(LANE)

    class State(Record):
        """Averages of the weights, factors set last; ticks of a difference, without a fit, of the dead time."""

        average: Vector = vector(LANE)
        set: Vector = vector(len(PARTS))
        held: float
        unknown: float
        dead: float

    class Ports(SupervisorPorts):
        """The weights of the hypotheses, and the estimate."""

        probability: Vector = reads("{diagnoser}.probability", "1", "weights of the hypotheses")
        request: float = output("1", "1 to set the model of the controller, 2 for safe outputs; 0 for none")
        estimate: Vector = tap("1", "weighted factor on the nominal device", labels=PARTS)
        difference: float = tap("1", "largest difference of a factor from the value set last")
        dead_ms: float = tap("ms", "time left in which nothing counts")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the factors of the hypotheses, and times in ticks."""
        p, nominal = cls.Packed.blank(), context.device
        take_waiting(p, params, context)
        p.keep = exp(-4.0 * context.dt_ms / params.hold_ms) if params.hold_ms > 0.0 else 0.0
        p.holds, p.trips = params.on_unknown == "hold", params.on_unknown == "safe"
        for i, device in enumerate(hypotheses(params, context).values()):
            p.mass[i], p.stiffness[i] = device.mass / nominal.mass, device.stiffness / nominal.stiffness
            p.damping[i] = device.damping / nominal.damping if nominal.damping > 0.0 else 1.0
            p.gain[i] = device.force / nominal.force if nominal.force != 0.0 else 1.0
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """Begin with the nominal device and the dead time."""
        s = cls.State.zeros()
        s.set[:] = 1.0
        s.dead = ticks(params.dead_ms, context)
        return s

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Average the weights, compute the estimate, and request it when it has changed."""
        n = int(p.count)
        keep = p.keep if s.dead <= 0.0 else 0.0
        mass = 0.0
        stiffness = 0.0
        damping = 0.0
        gain = 0.0
        for i in range(n):
            weight = flush_tiny(keep * s.average[i] + (1.0 - keep) * x.probability[i])
            if not math.isfinite(weight):
                weight = s.average[i]
            s.average[i] = weight
            mass += weight * p.mass[i]
            stiffness += weight * p.stiffness[i]
            damping += weight * p.damping[i]
            gain += weight * p.gain[i]
        first = max(abs(mass - s.set[0]), abs(stiffness - s.set[1]))
        difference = max(first, max(abs(damping - s.set[2]), abs(gain - s.set[3])))
        s.unknown = s.unknown + 1.0 if x.unexplained != 0.0 else 0.0
        s.held = s.held + 1.0 if difference > p.least_change else 0.0
        unknown = s.unknown > 0.0 and s.unknown >= p.hold
        request = 0.0
        if s.dead > 0.0:
            s.dead -= 1.0
            s.held = 0.0
            s.unknown = 0.0
        elif unknown and p.trips != 0.0:
            request = 2.0
        elif s.held > 0.0 and s.held >= p.hold and not (unknown and p.holds != 0.0):
            request = 1.0
            s.set[0] = mass
            s.set[1] = stiffness
            s.set[2] = damping
            s.set[3] = gain
        if request != 0.0:
            s.dead = p.dead
        x.request = request
        x.estimate[0] = mass
        x.estimate[1] = stiffness
        x.estimate[2] = damping
        x.estimate[3] = gain
        x.difference = difference
        x.dead_ms = s.dead * p.tick_ms

    @classmethod
    def requests(cls, params: Any, context: Context) -> int:
        """Return the requests: to set the model, and for safe outputs."""
        return 2

    @classmethod
    def acts(cls, params: Any, context: Context, request: int, value: Value) -> list[Act]:
        """Return the change of the controller to the estimate."""
        if request == 2:
            return (
                [{"make_safe": "the supervisor found no hypothesis that fits"}] if params.on_unknown == "safe" else []
            )
        estimate = {part: round(value(f"supervisor.estimate.{part}"), DIGITS) for part in PARTS}
        return [{"set": {f"controllers.{params.controller}.{part}_ratio": ratio for part, ratio in estimate.items()}}]

    @classmethod
    def reason(cls, params: Any, context: Context, request: int, value: Value) -> str:
        """Name the difference from the value set last."""
        if request == 2:
            return f"no hypothesis of {params.diagnoser} has fitted for {format_short(params.hold_ms, 'ms')}"
        share = format_short(100.0 * value("supervisor.difference"), "%", 2)
        return f"the estimate of {params.diagnoser} has moved by {share}"
