"""Base of supervisors: a number requests an act, and the board carries it out at the next tick edge."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar

from pydantic import Field

from core.block import Block, BlockParams, Context, parameter
from core.ports import BlockPorts, output, reads

MOST_ACTS = 64
"""Acts of a supervisor, and rows of its tables."""
Act = dict[str, Any]
"""An event of a scenario without its moment: it switches a controller, sets parameters or makes the outputs safe."""
Value = Callable[[str], float]


class SupervisorParams(BlockParams):
    """The diagnoser whose verdict counts."""

    diagnoser: str = parameter("kalman", "diagnoser whose verdict counts, by its id", live=False)


class ActParams(SupervisorParams):
    """The acts that a user's supervisor may request."""

    acts: list[Act] = Field(
        [],
        max_length=MOST_ACTS,
        description="the acts, each an event of a scenario without its moment; request 1 is the first",
        json_schema_extra={"unit": "", "live": True, "equation": ""},
    )


class SupervisorPorts(BlockPorts):
    """The verdict of the diagnoser, and the act that the supervisor requests."""

    winner: float = reads("{diagnoser}.winner", "1", "index of the most probable hypothesis")
    unexplained: float = reads("{diagnoser}.unexplained", "1", "1 while no hypothesis fits")
    request: float = output("1", "requested act, counted from 1; 0 for none")


class Supervisor(Block):
    """A supervisor runs at each tick, after the diagnosers and before the controllers.

    While ``request`` is n, the board carries out the n-th act at the next tick edge, before any command. An act is a
    consequence of the samples, not a command: it is derived anew wherever the same samples are computed.
    """

    Params: ClassVar[type[BlockParams]] = ActParams
    Ports = SupervisorPorts

    @classmethod
    def requests(cls, params: Any, context: Context) -> int:
        """Return how many different requests it may put out."""
        return len(params.acts)

    @classmethod
    def acts(cls, params: Any, context: Context, request: int, value: Value) -> list[Act]:
        """Return the acts of a request; ``value`` reads a signal of this tick."""
        return [params.acts[request - 1]] if request <= len(params.acts) else []

    @classmethod
    def reason(cls, params: Any, context: Context, request: int, value: Value) -> str:
        """Say why it requests this, for the log."""
        return f"request {request}"
