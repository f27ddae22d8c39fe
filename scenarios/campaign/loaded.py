"""Common data of all worker processes: loaded once, in their parent process.

Code takes more than a second to load, and compiled kernels half of one. This process has no work of its own.
"""

from __future__ import annotations

import gc

from scenarios.campaign.batch import FEWEST, outcomes
from scenarios.edit import with_values
from scenarios.kernels import FIRST_BENCH, complete
from scenarios.library import get

marker = complete()
if marker is not None and marker.exists():  # otherwise each is compiled by who needs it
    short = with_values(get(FIRST_BENCH), {"samples": 1})
    outcomes([(short, 1)])
    outcomes([(short, seed) for seed in range(FEWEST)])

gc.freeze()  # loaded objects stay: no collection looks at them again, and no process copies them
