"""A table of parameters for each hypothesis."""

from __future__ import annotations

from typing import Any

from pydantic import Field

from core.block import BlockParams, Context
from core.errors import InputError
from core.supervise.supervisor import MOST_ACTS, Act
from core.supervise.verdict import VerdictParams, VerdictSupervisor, check_names, nominal


class ScheduleRow(BlockParams):
    """The values of a hypothesis."""

    name: str = Field(min_length=1, max_length=24, description="name of the hypothesis")
    set: dict[str, Any] = Field(min_length=1, max_length=100, description="values by dotted path")


class Scheduling(VerdictSupervisor):
    """Sets the parameters that the table has for the hypothesis that the diagnoser names: scheduled gains.

    The row of the healthy device names all paths. A path that another row leaves out has its value from there.
    """

    title = "Schedule parameters"
    place = 2

    class Params(VerdictParams):
        """The table."""

        schedule: list[ScheduleRow] = Field(
            [],
            max_length=MOST_ACTS,
            description="values of each hypothesis; a hypothesis without a row has the values of the healthy device",
            json_schema_extra={"unit": "", "live": True, "equation": ""},
        )

    @classmethod
    def acts_for(cls, params: Any, context: Context, name: str) -> list[Act]:
        """Return the change to the values of a hypothesis."""
        rows = {row.name: row.set for row in params.schedule}
        check_names(params, context, rows, "schedule")
        usual = rows.get(nominal(params, context), {})
        for row, values in rows.items():
            if missing := [path for path in values if path not in usual]:
                raise InputError(f"{missing[0]} of {row} has no value for the healthy device", "schedule")
        values = usual | rows.get(name, {})
        return [{"set": values}] if values else []
