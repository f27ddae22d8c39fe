"""Positive real transfer functions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

import numpy as np
from pydantic import Field, model_validator

from core.block import BlockParams, parameter
from core.control.controller import normalised
from core.theory.positive_real import positive_real
from scenarios.studies.study import Study, StudyPicture

if TYPE_CHECKING:
    from core.board.board import Board


class PositiveRealCase(BlockParams):
    """A transfer function, highest power first."""

    name: str = Field(pattern=r"^[a-z0-9_]{1,32}$", description="name in the figures")
    numerator: list[float] = Field(min_length=1, max_length=21, description="highest power first")
    denominator: list[float] = Field(min_length=1, max_length=21, description="highest power first")


class PositiveReal(Study):
    """Judges transfer functions: ``spr.<name>`` is 2 if strictly positive real, 1 if positive real, 0 if neither.

    With them the device of the bench in time of 1/w0: its displacement, its velocity, and displacement plus velocity
    over nine tenths of the damping; a device of first order has none of these. With ``combine`` also the combinations
    of A.11 of the first two cases: ``inverse`` of the first, their ``sum``, and ``feedback``, the first closed by the
    second.
    """

    title = "Positive real"

    class Params(BlockParams):
        """Which transfer functions."""

        cases: list[PositiveRealCase] = Field([], max_length=100, description="transfer functions to judge")
        combine: bool = parameter(False, "judge inverse, sum and feedback of the first two too", equation="A.11.1")

        @model_validator(mode="after")
        def _two_to_combine(self) -> Self:
            if self.combine and len(self.cases) < 2:
                raise ValueError("combine needs two cases")
            return self

    @classmethod
    def figures(cls, board: Board, params: Any) -> dict[str, float]:
        """Return the verdicts, and the smallest real part on the axis where it is finite."""
        results = {}
        for name, numerator, denominator in cls._cases(board, params):
            verdict = positive_real(numerator, denominator)
            results[f"spr.{name}"] = 2.0 if verdict.strictly_positive_real else 1.0 if verdict.positive_real else 0.0
            results[f"spr.{name}_relative_degree"] = float(verdict.relative_degree)
        return results

    @classmethod
    def picture(cls, board: Board, params: Any) -> StudyPicture:
        """Return the real part on the imaginary axis, each over its largest size: below 0 it is not positive real."""
        omega = np.geomspace(0.01, 100.0, 200)
        curves = []
        for name, numerator, denominator in cls._cases(board, params):
            real = np.real(np.polyval(numerator, 1j * omega) / np.polyval(denominator, 1j * omega))
            curves.append((name.replace("_", " "), omega.tolist(), (real / np.max(np.abs(real))).tolist()))
        return StudyPicture(("angular frequency", ""), ("real part", ""), curves, is_log_x=True)

    @staticmethod
    def _cases(board: Board, params: Any) -> list[tuple[str, list[float], list[float]]]:
        """Return name, numerator and denominator of every transfer function."""
        device = board.spec.context().device
        cases = [(case.name, case.numerator, case.denominator) for case in params.cases]
        if params.combine:
            (_, n1, d1), (_, n2, d2) = cases[:2]
            both = np.polymul(d1, d2)
            cases += [
                ("inverse", d1, n1),
                ("sum", np.polyadd(np.polymul(n1, d2), np.polymul(n2, d1)).tolist(), both.tolist()),
                ("feedback", np.polymul(n1, d2).tolist(), np.polyadd(both, np.polymul(n1, n2)).tolist()),
            ]
        if device.mass > 0.0:
            a1, a2, _ = normalised(device, device.natural_frequency)
            below = [1.0, a1, a2]
            cases += [
                ("displacement", [1.0], below),
                ("velocity", [1.0, 0.0], below),
                ("with_velocity", [1.0, 0.9 * a1], below),
            ]
        return cases
