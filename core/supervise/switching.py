"""A controller for each hypothesis."""

from __future__ import annotations

from typing import Any

from pydantic import Field

from core.block import Context, parameter
from core.supervise.supervisor import MOST_ACTS, Act
from core.supervise.verdict import VerdictParams, VerdictSupervisor, check_names


class Switching(VerdictSupervisor):
    """Switches to the controller of the hypothesis that the diagnoser names (5.1.6: diagnosis, then redesign).

    The switch is bumpless as far as the law that takes over has followed the loop in shadow.
    """

    title = "Switch the controller"
    place = 1

    class Params(VerdictParams):
        """The controllers."""

        nominal: str = parameter("lqg", "controller of every hypothesis without one of its own")
        controllers: dict[str, str] = Field(
            {},
            max_length=MOST_ACTS,
            description="controllers, by hypothesis",
            json_schema_extra={"unit": "", "live": True, "equation": ""},
        )

    @classmethod
    def acts_for(cls, params: Any, context: Context, name: str) -> list[Act]:
        """Return the switch to the controller of a hypothesis."""
        check_names(params, context, params.controllers, "controllers")
        return [{"switch": params.controllers.get(name, params.nominal)}]
