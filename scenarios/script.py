"""A run as a Python script that repeats it over REST, with nothing but Python's own library."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pprint import pformat
from typing import Any

TEMPLATE = '''"""Run {name} on a CombBench server, and check that it gives the same bits.

    python {file} [ADDRESS] [TOKEN]

ADDRESS is http://127.0.0.1:8000 unless given, TOKEN is read from COMBBENCH_TOKEN unless given.
The trace is written beside this file. A server of another version may give other bits.
"""

import json
import os
import sys
import time
import urllib.request

ADDRESS = (sys.argv[1] if len(sys.argv) > 1 else "http://127.0.0.1:8000").rstrip("/") + "/api/v1"
TOKEN = sys.argv[2] if len(sys.argv) > 2 else os.environ.get("COMBBENCH_TOKEN", "")

SCENARIO = {scenario}
SEEDS = {seeds}  # first, and the one behind the last
DIGEST = "{digest}"


def call(path, body=None):
    """Ask the server; a body makes it a POST."""
    headers = {{"Authorization": f"Bearer {{TOKEN}}", "Content-Type": "application/json"}}
    data = None if body is None else json.dumps(body).encode()
    with urllib.request.urlopen(urllib.request.Request(ADDRESS + path, data, headers)) as answer:
        return answer.read()


run = json.loads(call("/runs", {{"scenario": SCENARIO, "seeds": SEEDS}}))
while run["state"] in ("queued", "running"):
    time.sleep(0.2)
    run = json.loads(call(f"/runs/{{run['id']}}"))
if run["state"] != "done":
    sys.exit(f"the run is {{run['state']}}: {{(run['error'] or {{}}).get('message', '')}}")
for metric, value in run["summary"]["metrics"].items():
    print(f"{{metric:<44}} {{value:.6g}}")
if run["summary"]["ticks"]:
    every = 1 + run["summary"]["ticks"] // 100_000
    what = f"format=csv&signals=plant.displacement,drive.voltage&every={{every}}"
    with open(os.path.splitext(__file__)[0] + ".csv", "wb") as file:
        file.write(call(f"/runs/{{run['id']}}/trace?{{what}}"))
print("digest", run["summary"]["digest"])
if run["summary"]["digest"] != DIGEST:
    sys.exit(f"other bits than {{DIGEST}}")
'''


def script(document: dict[str, Any], seeds: Sequence[int], digest: str, file: str) -> str:
    """Return the script.

    Parameters
    ----------
    document : dict
        The scenario.
    seeds : sequence of int
        Whole numbers in a row.
    digest : str
        What the run gave.
    file : str
        What the script will be called.
    """
    plain = json.loads(json.dumps(document, default=str))
    return TEMPLATE.format(
        name=str(plain.get("id", "a scenario")),
        file=file,
        scenario=pformat(plain, width=110, sort_dicts=False),
        seeds=[seeds[0], seeds[-1] + 1],
        digest=digest,
    )
