"""A run or a campaign as a Python script that repeats it over REST, with nothing but Python's own library."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pprint import pformat
from typing import Any

from core.board.document import plant_of

HEAD = '''"""{does}

    python {file} [ADDRESS] [TOKEN]

ADDRESS is http://127.0.0.1:8000 unless given, TOKEN is read from COMBBENCH_TOKEN unless given.
{leaves} A server of another version may give other bits.
"""

import json
import os
import sys
import time
import urllib.request

ADDRESS = (sys.argv[1] if len(sys.argv) > 1 else "http://127.0.0.1:8000").rstrip("/") + "/api/v1"
TOKEN = sys.argv[2] if len(sys.argv) > 2 else os.environ.get("COMBBENCH_TOKEN", "")

{data}


def call(path, body=None):
    """Ask the server; a body makes it a POST."""
    headers = {{"Authorization": f"Bearer {{TOKEN}}", "Content-Type": "application/json"}}
    data = None if body is None else json.dumps(body).encode()
    with urllib.request.urlopen(urllib.request.Request(ADDRESS + path, data, headers)) as answer:
        return answer.read()


'''

RUN = """run = json.loads(call("/runs", {"scenario": SCENARIO, "seeds": SEEDS}))
while run["state"] in ("queued", "running"):
    time.sleep(0.2)
    run = json.loads(call(f"/runs/{run['id']}"))
if run["state"] != "done":
    sys.exit(f"the run is {run['state']}: {(run['error'] or {}).get('message', '')}")
for metric, value in run["summary"]["metrics"].items():
    print(f"{metric:<44} {value:.6g}")
if run["summary"]["ticks"]:
    every = 1 + run["summary"]["ticks"] // 100_000
    what = f"format=csv&signals={SIGNALS}&every={every}"
    with open(os.path.splitext(__file__)[0] + ".csv", "wb") as file:
        file.write(call(f"/runs/{run['id']}/trace?{what}"))
print("digest", run["summary"]["digest"])
if run["summary"]["digest"] != DIGEST:
    sys.exit(f"other bits than {DIGEST}")
"""

CAMPAIGN = """sweep = json.loads(call("/sweeps", {"sweep": SWEEP}))
while sweep["state"] in ("queued", "running"):
    time.sleep(0.5)
    sweep = json.loads(call(f"/sweeps/{sweep['id']}"))
    print(f"{sweep['done']} of {sweep['runs']} runs", file=sys.stderr)
if sweep["state"] != "done":
    sys.exit(f"the campaign is {sweep['state']}: {(sweep['error'] or {}).get('message', '')}")
for point in json.loads(call(f"/sweeps/{sweep['id']}/points"))["points"]:
    print(point["labels"], f"{point['ok']} of {point['runs']} runs as expected")
stem = os.path.splitext(__file__)[0]
for path, ending in ("runs", ".csv"), ("report", ".html"):
    with open(stem + ending, "wb") as file:
        file.write(call(f"/sweeps/{sweep['id']}/{path}"))
"""


def script(document: dict[str, Any], seeds: Sequence[int], digest: str, file: str) -> str:
    """Return the script of a run.

    Parameters
    ----------
    document : dict
        The scenario.
    seeds : sequence of int
        Whole numbers in a row.
    digest : str
        Digest of the run.
    file : str
        Name of the script.
    """
    plain = _plain(document)
    head = HEAD.format(
        does=f"Run {plain.get('id', 'a scenario')} on a CombBench server, and check that it gives the same bits.",
        leaves="The trace is written beside this file.",
        file=file,
        data=f'SCENARIO = {_say(plain)}\nSEEDS = "{seeds[0]}:{seeds[-1]}"  # both included\n'
        f'DIGEST = "{digest}"\nSIGNALS = "{",".join(_recorded(plain))}"',
    )
    return head + RUN


def campaign_script(document: dict[str, Any], file: str) -> str:
    """Return the script of a campaign.

    Parameters
    ----------
    document : dict
        The campaign.
    file : str
        Name of the script.
    """
    plain = _plain(document)
    head = HEAD.format(
        does=f"Run the campaign {plain.get('id', 'sweep')} on a CombBench server.",
        leaves="Table and report are written beside this file.",
        file=file,
        data=f"SWEEP = {_say(plain)}",
    )
    return head + CAMPAIGN


def _recorded(document: dict[str, Any]) -> list[str]:
    """Return the signals whose trace is written: the motion of the plant, and its drive."""
    axes = plant_of(document).axes
    if not axes:
        return ["plant.displacement", "drive.voltage"]
    return ["rate.rate", *(f"plant.{axis}" for axis in axes), *(f"drive.{axis}.force" for axis in axes)]


def _plain(document: dict[str, Any]) -> dict[str, Any]:
    plain: dict[str, Any] = json.loads(json.dumps(document, default=str))
    return plain


def _say(document: dict[str, Any]) -> str:
    return pformat(document, width=110, sort_dicts=False)
