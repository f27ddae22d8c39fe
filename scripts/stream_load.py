"""Stream an instrument into a server of our own on loopback, measure, and say whether it kept its promises.

The instrument sends a record at a fixed rate in blocks; a bench plays it with the banks of a scenario. No block may be
lost, and the last verdict on a block comes within 100 ms of the block.
"""

from __future__ import annotations

import argparse
import json
import os
import socket
import struct
import tempfile
import time
from pathlib import Path
from typing import Any

import httpx
import numpy as np
from load import Server  # of this folder

MOST_LATENCY_MS = 100.0
LOOK_S = 10.0
"""Between two looks at the bench; the server knows the latencies of its last 1000 blocks."""


class Instrument:
    """A connection that sends blocks on time, and counts the blocks that it sends late.

    Parameters
    ----------
    listens : str
        Address and port of the server.
    rate_khz, blocks_per_s : float
        Samples for each ms, and blocks for each second.
    """

    def __init__(self, listens: str, rate_khz: float, blocks_per_s: float) -> None:
        host, _, port = listens.rpartition(":")
        self._socket = socket.create_connection((host, int(port)))
        self._rate_khz, self._interval_s = rate_khz, 1.0 / blocks_per_s
        header = {"version": 1, "source": "load", "rate_khz": rate_khz}
        self._socket.sendall(json.dumps(header).encode() + b"\n")
        assert json.loads(self._socket.makefile("rb").readline()) == {"ok": True}
        self.sent = self.late = self._first = 0
        self._begun = 0.0

    def send(self) -> None:
        """Wait for the end of the next block, and send it."""
        now = time.monotonic()
        self._begun = self._begun or now
        due = self._begun + (self.sent + 1) * self._interval_s
        self.late += now > due + self._interval_s
        time.sleep(max(0.0, due - now))
        end = round((self.sent + 1) * self._interval_s * 1e3 * self._rate_khz)
        phase = 2.0 * np.pi * 2.0 / self._rate_khz * np.arange(self._first, end)
        pairs = np.column_stack((40.0 * np.sin(phase), 0.5 * np.sin(phase - 1.0))).astype("<f8")
        head = struct.pack("<QqI", self.sent, round(self._first * 1e6 / self._rate_khz), len(pairs))
        self._socket.sendall(head + pairs.tobytes())
        self.sent, self._first = self.sent + 1, end


def measure(options: argparse.Namespace, data: Path) -> dict[str, Any]:
    """Stream for a while; return the figures."""
    os.environ |= {"COMBBENCH_INSTRUMENT_PORT": "0", "COMBBENCH_RECORDS": str(data / "records")}
    server = Server(data, 1)
    try:
        server.wait_ready()
        server.http.timeout = httpx.Timeout(120.0)
        instrument = Instrument(
            server.get("/api/v1/instruments")["listens"], 1e-3 * options.samples_per_s, options.blocks_per_s
        )
        bench = server.post("/api/v1/instruments/load/benches", {"scenario": options.scenario})["id"]
        before, own = server.processor_s(), time.process_time()
        begun = looked = time.monotonic()
        latencies, lags = [], []
        while time.monotonic() - begun < options.seconds:
            instrument.send()
            if time.monotonic() - looked >= LOOK_S:
                looked = time.monotonic()
                status = server.get(f"/api/v1/benches/{bench}")["instrument"]
                latencies.append(status["latency_p95_ms"])
                lags.append(status["lag_ms"])
        took = time.monotonic() - begun
        used = (server.processor_s() - before) / took, (time.process_time() - own) / took
        time.sleep(1.0)
        status = server.get(f"/api/v1/benches/{bench}")
        found = status["instrument"]
        return {
            "seconds": round(took, 1),
            "blocks_sent": instrument.sent,
            "blocks_sent_late": instrument.late,
            "blocks": found["blocks"],
            "lost_blocks": found["lost_blocks"] + found["late_blocks"] + found["doubled_blocks"],
            "lost_samples": found["lost_samples"],
            "samples": found["samples"],
            "samples_played": status["tick"],
            "latency_p95_ms": max([*latencies, found["latency_p95_ms"]]),
            "latency_p95_median_ms": sorted(latencies)[len(latencies) // 2] if latencies else None,
            "lag_ms": max(lags, default=0.0),
            "server_processors": round(used[0], 3),
            "own_processors": round(used[1], 3),
            "memory_mb": round(server.memory_mb()),
            "load_average": os.getloadavg(),
        }
    finally:
        server.stop()


def main() -> None:
    """Measure, print, and fail where a promise is broken."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--seconds", type=float, default=600.0)
    options.add_argument("--samples-per-s", type=float, default=100_000.0)
    options.add_argument("--blocks-per-s", type=float, default=30.0)
    options.add_argument("--scenario", default="first-look")
    with tempfile.TemporaryDirectory() as folder:
        found = measure(options.parse_args(), Path(folder))
    print(json.dumps(found, indent=2))
    is_whole = found["blocks"] == found["blocks_sent"] and found["samples_played"] == found["samples"]
    if not is_whole or found["lost_blocks"] or found["lost_samples"]:
        raise SystemExit("blocks were lost")
    if found["latency_p95_ms"] > MOST_LATENCY_MS:
        raise SystemExit(f"verdicts came later than {MOST_LATENCY_MS:g} ms")


if __name__ == "__main__":
    main()
