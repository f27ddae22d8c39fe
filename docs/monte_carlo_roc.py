# %% [markdown]
# # How well does a diagnoser separate a fault from noise?
#
# A diagnoser gives the probability of a fault; at which probability should one act? The receiver operating
# characteristic answers for every threshold at once: the detected share of the faulty samples over the share of healthy
# samples with a false alarm. Here it is measured by Monte Carlo: the seven faults of chapter 5, many seeds, and four
# levels of sensor noise, while the filters still assume the usual 0.05 um.
#
# Cells are marked with `# %%`; an editor with notebooks runs them one by one, `python docs/monte_carlo_roc.py` all.

# %% The campaign: seeds are shared by all points, so that points differ by their noise alone
import json
import math
import subprocess
from pathlib import Path

from scenarios.report.axis import Axis
from scenarios.report.svg import REPORT, Chart, Series, picture_file

RUNS = 100
FOLDER = Path("monte-carlo-roc")
NOISE_UM = [0.05, 0.1, 0.2, 0.4]
CAMPAIGN = f"""
schema = 1
id = "monte-carlo-roc"
title = "Faults told from noise"
scenario = "ch5-seven-step"
seeds = "1:{RUNS}"
[set]
"diagnosers.kalman.sensor_noise_um" = 0.05
[grid]
"sensor.noise_um" = {NOISE_UM}
"""

# %% Run it on all processors; started again it continues from the runs that are done
Path("monte-carlo-roc.toml").write_text(CAMPAIGN)
subprocess.run(["combbench", "sweep", "monte-carlo-roc.toml", "--out", FOLDER, "--resume"], check=True)

# %% Area under the curve for each noise, and the uncertainty of Monte Carlo
points = json.loads((FOLDER / "points.json").read_text())
print("noise, um   area     samples right, mean ± standard error of the mean")
areas = []
for point in points:
    roc = point["diagnosis"]["kalman"]["roc"]
    right = point["metrics"]["diagnosis.kalman.correct_fraction"]
    error = right["std"] / math.sqrt(right["count"])
    areas.append(roc["area"])
    print(f"{point['labels']['sensor.noise_um']:<10}  {roc['area']:.4f}   {right['mean']:.4f} ± {error:.4f}")

# %% The threshold that loses least: largest detections minus false alarms (Youden 1950)
for point in points:
    roc = point["diagnosis"]["kalman"]["roc"]
    gain = [d - f for d, f in zip(roc["detection"][1:], roc["false_alarm"][1:], strict=True)]
    best = gain.index(max(gain))
    odds = 10.0 ** roc["log10_odds"][best]
    print(
        f"noise {point['labels']['sensor.noise_um']} µm: act above a probability of {odds / (1.0 + odds):.3f}, "
        f"detect {roc['detection'][best + 1]:.3f} with {roc['false_alarm'][best + 1]:.3f} false alarms"
    )

# %% The curves as a drawing; the whole report is monte-carlo-roc/report.html
curves = [
    Series(f"{point['labels']['sensor.noise_um']} µm", roc["false_alarm"], roc["detection"])
    for point in points
    for roc in [point["diagnosis"]["kalman"]["roc"]]
]
whole = (0.0, 1.0)
chart = Chart("Faults told from noise", Axis("false alarms", "", whole), Axis("detections", "", whole), curves)
(FOLDER / "roc.svg").write_text(picture_file(chart, REPORT), "utf-8")
