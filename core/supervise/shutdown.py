"""Safe outputs when the device is no longer healthy."""

from __future__ import annotations

from typing import Any

from core.block import Context
from core.supervise.supervisor import Act
from core.supervise.verdict import VerdictSupervisor, nominal


class Shutdown(VerdictSupervisor):
    """Takes the outputs to their safe values, as a trip does, once the diagnoser names a fault (5.1.5: safe to fail).

    A reset of the trip starts the supervisor anew; it shuts down again while the fault acts.
    """

    title = "Shut down"
    place = 4

    @classmethod
    def acts_for(cls, params: Any, context: Context, name: str) -> list[Act]:
        """Return the way to the safe outputs, for any hypothesis but the healthy one."""
        return (
            []
            if name == nominal(params, context)
            else [{"make_safe": f"the supervisor trusts {params.diagnoser}, which names {name}"}]
        )
