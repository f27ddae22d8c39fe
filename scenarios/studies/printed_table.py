"""Printed devices against the equations."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from core.block import BlockParams, parameter
from core.device.catalogue import devices
from core.errors import unknown
from scenarios.studies.study import Study

if TYPE_CHECKING:
    from core.board.board import Board

COLUMNS = ("min", "std", "max")


class PrintedTable(Study):
    r"""Compares the devices of a printed table with 1.3.4 and 1.3.5.

    For each device: resonance from its stiffness and mass, as printed, and the error of the printed one; the spring
    by 1.3.4 against the printed spring. For each column: the error that is largest in size. ``one_side_error_pct`` is
    the error that :math:`\sqrt{k_s/m}` with the spring of one side alone would give.
    """

    title = "Printed devices"

    class Params(BlockParams):
        """Which devices."""

        prefix: str = parameter("table-1-1-", "the devices whose id begins so")

    @classmethod
    def figures(cls, board: Board, params: Any) -> dict[str, float]:  # noqa: ARG003 (the table is its own bench)
        """Return the figures of every device, and the largest error of each column."""
        chosen = [device for device in devices() if device.id.startswith(params.prefix) and device.printed is not None]
        if not chosen:
            raise unknown("table", params.prefix, ["table-1-1-"], "study.prefix")
        results: dict[str, float] = {}
        worst: dict[str, float] = {}

        def keep(name: str, error: float) -> None:
            if abs(error) >= abs(worst.get(name, 0.0)):
                worst[name] = error

        for device in chosen:
            printed = device.printed
            assert printed is not None
            figures = device.metrics()
            prefix = f"table.{device.id.removeprefix(params.prefix)}"
            column = device.id.rpartition("-")[2]
            results[f"{prefix}.f0_hz"] = figures["f0_hz"]
            spring, mass, f0 = printed.one_side_stiffness_n_m, printed.mass_kg, printed.f0_hz
            if spring is not None:
                results[f"{prefix}.one_side_stiffness_n_m"] = 0.5 * figures["stiffness_n_m"]
                error = 100.0 * (0.5 * figures["stiffness_n_m"] / spring - 1.0)
                results[f"{prefix}.spring_error_pct"] = error
                keep("table.spring_error_pct", error)
            if mass is not None:
                keep("table.mass_error_pct", 100.0 * (mass / figures["mass_kg"] - 1.0))
            if f0 is not None:
                error = 100.0 * (f0 / figures["f0_hz"] - 1.0)
                results |= {f"{prefix}.f0_printed_hz": f0, f"{prefix}.f0_error_pct": error}
                if column in COLUMNS:
                    keep(f"table.{column}_f0_error_pct", error)
            if spring is not None and f0 is not None:
                two = math.sqrt(2.0 * spring / figures["mass_kg"]) / (2.0 * math.pi)
                if column in COLUMNS:
                    keep(f"table.{column}_f0_two_springs_error_pct", 100.0 * (two / f0 - 1.0))
                    keep(f"table.{column}_f0_one_spring_error_pct", 100.0 * (two / math.sqrt(2.0) / f0 - 1.0))
        return {**results, **worst}
