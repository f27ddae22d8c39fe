"""Tags of the OpenAPI document: the groups of its operations, in the order of the document."""

from __future__ import annotations

TAGS = {
    "catalogue": "Blocks with their equations, parameters and ports",
    "devices": "Devices and their derived figures, frequency response and process spread",
    "scenarios": "Scenarios of the library, and the check of a text",
    "units": "Controllers, diagnosers and other blocks that people write",
    "benches": "Live benches, commands to them, events and forks",
    "experiments": "Measurements on a copy of a bench",
    "diagnosers": "What a diagnoser concludes from its samples, and which hypotheses it cannot tell apart",
    "readouts": "Evaluations of the angular rate",
    "claims": "Published figures and claims beside the figures of a bench",
    "snapshots": "Kept moments of a bench",
    "parameter sets": "Named values of parameters, kept for other benches",
    "recordings": "Recorded spans of a bench: their traces, their replay and their comparison",
    "trace": "Samples of a live bench",
    "runs": "Headless runs: their summaries, traces and reports",
    "sweeps": "Campaigns: a scenario at many points with many seeds",
    "thresholds": "Searches for the value at which a claim begins to hold",
    "gallery": "Experiments of the library: claimed, expected and measured figures",
    "benchmarks": "Benchmarks of diagnosers and their results",
    "theory": "Properties that follow from equations, without a run",
    "links": "Experiments kept by a short id",
    "lectures": "Lectures and their cues",
    "classes": "Classes, their students, the driver of a bench, watchers and the audit",
    "pages": "Parts of the page that the server draws",
    "blind": "Hidden faults and the answers to them",
    "games": "Games at a seed, and their tables",
    "votes": "Votes of a class",
    "sheets": "Lab sheets, their steps, reports and grades",
    "health": "State and metrics of the server",
}
