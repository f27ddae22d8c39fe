"""Read-outs of a live bench: the Allan deviation of the rate so far, and the estimates of its noises."""

from __future__ import annotations

import numpy as np

from scenarios.measure.rate_readout import RateReadout, rate_readout, readout_signals
from server.api.deps import SessionDep
from server.api.router import Router

router = Router(prefix="/benches/{bench_id}/readouts", tags=["readouts"])


@router.get("/{name}")
def get_readout(session: SessionDep, name: str) -> RateReadout:
    """Fit angle random walk, bias instability and rate random walk to the record so far."""
    spec, tick = session.board.spec, session.history.end_tick
    columns = session.indices(readout_signals(spec, name))
    latest = session.history.read(columns, tick - 1, tick)
    values = latest[:, 0].astype(float) if latest.shape[1] else np.zeros(len(columns))
    return rate_readout(spec, name, tick, values)
