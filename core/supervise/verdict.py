"""Base of supervisors that act on a verdict: a weight over a threshold, for long enough."""

from __future__ import annotations

import math
from typing import Any, ClassVar, Literal

from core.block import BlockParams, Context, Equation, Oscillator, Stage, parameter
from core.diagnose.weights import winner_of
from core.errors import unknown
from core.format import format_share, format_short
from core.ports import output, reads, tap
from core.record import Choice, Record, Vector
from core.supervise.supervisor import Act, Supervisor, SupervisorParams, SupervisorPorts, Value

NONE = -1
"""The verdict while no weight is over the threshold."""


class WaitingParams(SupervisorParams):
    """How long a verdict must last, and how long nothing counts after an act."""

    hold_ms: float = parameter(1.0, "time for which a verdict must last", "ms", ge=0, le=1e6)
    dead_ms: float = parameter(
        1.0, "time after an act, and after the start, in which nothing counts", "ms", ge=0, le=1e6
    )


class VerdictParams(WaitingParams):
    """When a weight is a verdict, and what happens when no hypothesis fits."""

    threshold: float = parameter(0.9, "weight from which a hypothesis is the verdict", gt=0, le=1)
    release: float = parameter(0.5, "weight below which the hypothesis acted on is left", ge=0, le=1)
    on_unknown: Literal["hold", "nominal", "safe"] = parameter(
        "hold",
        "act while no hypothesis fits: hold leaves the loop as it is, nominal treats the device as healthy, safe trips",
    )


class WaitingPacked(Record):
    """Number of hypotheses; ticks for which a verdict must last, and in which nothing counts; length of a tick."""

    count: Choice
    hold: float
    dead: float
    tick_ms: float


class VerdictPacked(WaitingPacked):
    """In addition the limits of a weight, and whether it acts when no hypothesis fits."""

    threshold: float
    release: float
    acts_on_unknown: float


class VerdictState(Record):
    """The verdict now, the verdict acted on, ticks that the former has lasted, ticks left in which nothing counts."""

    verdict: float
    acting: float
    held: float
    dead: float


class VerdictPorts(SupervisorPorts):
    """The weights of the hypotheses, and why the supervisor acts or waits."""

    probability: Vector = reads("{diagnoser}.probability", "1", "weights of the hypotheses")
    request: float = output("1", "requested act: 1 for the first hypothesis, one more than their number for none")
    verdict: float = tap("1", "hypothesis that the weights name now; their number when none fits, -1 without a verdict")
    acting: float = tap("1", "verdict that was acted on last, -1 before the first")
    weight: float = tap("1", "largest weight")
    held_ms: float = tap("ms", "time for which the verdict has lasted")
    dead_ms: float = tap("ms", "time left in which nothing counts")


class VerdictSupervisor(Supervisor):
    """A verdict that differs from the verdict acted on, and has lasted for the time required, requests its act.

    Nothing counts in the dead time after the start: a bank begins with equal weights and names a winner at once. The
    hypothesis that was acted on is left only below ``release``.
    """

    equations: ClassVar[tuple[Equation, ...]] = (
        Equation("verdict", r"k=\arg\max_ip_i\ \text{if}\ p_k\ge p_{on};\quad k=a\ \text{while}\ p_a\ge p_{off}"),
        Equation("request", r"k\ne a\ \text{for}\ T_{hold}\;\Rightarrow\;a\leftarrow k"),
    )
    structure: ClassVar[tuple[Stage, ...]] = (
        Stage("Verdict", "probability winner unexplained acting", "verdict weight", ("verdict",)),
        Stage("Hold and dead time", "verdict", "request acting held_ms dead_ms", ("request",)),
    )
    weaknesses: ClassVar[tuple[str, ...]] = ("A verdict that is wrong for longer than the hold time is acted on.",)
    Params: ClassVar[type[BlockParams]] = VerdictParams
    Packed: ClassVar[type[Record]] = VerdictPacked
    State: ClassVar[type[Record]] = VerdictState
    Ports = VerdictPorts

    @classmethod
    def pack(cls, params: Any, context: Context) -> Any:
        """Pack the number of hypotheses, and times in ticks."""
        p: Any = cls.Packed.blank()
        take_waiting(p, params, context)
        p.acts_on_unknown = params.on_unknown != "hold"
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> Any:
        """Begin without a verdict, with the dead time."""
        s: Any = cls.State.zeros()
        s.verdict = s.acting = NONE
        s.dead = ticks(params.dead_ms, context)
        return s

    @staticmethod
    def step(p: VerdictPacked, s: VerdictState, x: VerdictPorts) -> None:
        """Name the verdict, count how long it lasts, and request its act."""
        n = int(p.count)
        winner = winner_of(x.probability, n)
        weight = x.probability[winner]
        verdict = -1.0
        if weight >= p.threshold:
            verdict = float(winner)
        acted = int(min(max(s.acting, 0.0), n - 1.0))
        if float(acted) == s.acting and x.probability[acted] >= p.release:
            verdict = s.acting
        if x.unexplained != 0.0:
            verdict = float(n)
        if not math.isfinite(weight):
            verdict = -1.0
        s.held = s.held + 1.0 if verdict == s.verdict else 1.0
        s.verdict = verdict
        request = 0.0
        if s.dead > 0.0:
            s.dead -= 1.0
            s.held = 0.0
        elif verdict >= 0.0 and verdict != s.acting and s.held >= p.hold:
            if verdict < n or p.acts_on_unknown != 0.0:
                request = verdict + 1.0
                s.acting = verdict
                s.dead = p.dead
        x.request = request
        x.verdict = verdict
        x.acting = s.acting
        x.weight = weight
        x.held_ms = s.held * p.tick_ms
        x.dead_ms = s.dead * p.tick_ms

    @classmethod
    def requests(cls, params: Any, context: Context) -> int:
        """Return the number of hypotheses, and one more for none of them."""
        return len(hypotheses(params, context)) + 1

    @classmethod
    def acts(cls, params: Any, context: Context, request: int, value: Value) -> list[Act]:
        """Return the acts for a hypothesis; when none fits, of the parameter for it."""
        names = [*hypotheses(params, context)]
        if request <= len(names):
            return cls.acts_for(params, context, names[request - 1])
        if params.on_unknown == "safe":
            return [{"make_safe": "the supervisor found no hypothesis that fits"}]
        return cls.acts_for(params, context, nominal(params, context)) if params.on_unknown == "nominal" else []

    @classmethod
    def acts_for(cls, params: Any, context: Context, name: str) -> list[Act]:
        """Return the acts for a hypothesis."""
        raise NotImplementedError

    @classmethod
    def reason(cls, params: Any, context: Context, request: int, value: Value) -> str:
        """Name the hypothesis, its weight, and how long it has lasted."""
        names, held = [*hypotheses(params, context)], format_short(params.hold_ms, "ms")
        if request > len(names):
            return f"no hypothesis of {params.diagnoser} has fitted for {held}"
        weight = format_share(value("supervisor.weight"), 3)
        return f"{params.diagnoser} has named {names[request - 1]} for {held}, weight {weight}"


def hypotheses(params: Any, context: Context) -> dict[str, Oscillator]:
    """Return the hypotheses of the diagnoser, each with its device.

    Raises
    ------
    InputError
        When the bench has no such diagnoser.
    """
    bank = context.banks.get(params.diagnoser)
    if bank is None:
        raise unknown("diagnoser with hypotheses", params.diagnoser, [*context.banks], "diagnoser")
    return dict(bank)


def nominal(params: Any, context: Context) -> str:
    """Return the hypothesis that takes nothing for changed; the first one if all of them do."""
    bank = hypotheses(params, context)
    return next((name for name, device in bank.items() if device == context.device), next(iter(bank)))


def check_names(params: Any, context: Context, names: Any, field: str) -> None:
    """Refuse a name that is no hypothesis of the diagnoser."""
    known = hypotheses(params, context)
    for name in names:
        if name not in known:
            raise unknown("hypothesis", name, [*known], field)


def ticks(ms: float, context: Context) -> int:
    """Return a time in ticks of the board."""
    return round(ms / context.dt_ms)


def take_waiting(p: Any, params: Any, context: Context) -> None:
    """Pack the number of hypotheses, and the times in ticks."""
    p.count = len(hypotheses(params, context))
    p.hold, p.dead, p.tick_ms = ticks(params.hold_ms, context), ticks(params.dead_ms, context), context.dt_ms
