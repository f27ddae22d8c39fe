"""CombBench from Python: run scenarios and campaigns here, or speak to a server.

import combbench as cb

result = cb.run("ch5-seven-step", seed=7)
result.figures["rms_error"]
result.to_xarray()["plant.displacement"].plot()
"""

from __future__ import annotations

from combbench.campaign import CampaignResult, sweep
from combbench.client import Client
from combbench.result import Result
from combbench.scenario import Scenario, run
from core.device.catalogue import devices
from core.errors import InputError
from core.registry import catalog
from server.version import VERSION as __version__

__all__ = [
    "CampaignResult",
    "Client",
    "InputError",
    "Result",
    "Scenario",
    "__version__",
    "catalog",
    "devices",
    "run",
    "sweep",
]
