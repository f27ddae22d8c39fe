"""The command that runs a scenario, over some seeds, or until it is known where a claim holds."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from typing import Annotated

import typer

from core.errors import InputError
from scenarios.edit import parse_assignment, with_values
from scenarios.report.text import run_text
from scenarios.report.traces import TraceFile
from scenarios.run import run as run_scenario
from scenarios.samples import temporary_folder
from scenarios.schema import Scenario
from scenarios.seeds import parse_seeds
from server.cli.terminal import AssignOption, JsonOption, load, plainly, say, say_json
from server.cli.units import UnitOption


@plainly
def run(
    scenario: Annotated[str, typer.Argument(help="Library id or file.")],
    assign: AssignOption = None,
    units: UnitOption = None,
    seed: Annotated[int | None, typer.Option(help="A seed in place of the scenario's own, 0 or more.")] = None,
    seeds: Annotated[str | None, typer.Option(metavar="A:B", help="One run for each seed from A to B.")] = None,
    as_json: JsonOption = False,
    out: Annotated[Path | None, typer.Option(metavar="DIR", help="Write trace, report and script here.")] = None,
    everything: Annotated[
        bool,
        typer.Option(
            "--all",
            help="Also run the controllers that never drive, and write all signals to the trace, "
            "also of sensors that are never in use. No figure and no digest depends on it.",
        ),
    ] = False,
    narrate: Annotated[bool, typer.Option("--narrate", help="Also print the sentences of the narrator.")] = False,
    controller_process: Annotated[
        str | None,
        typer.Option(metavar="COMMAND", help="A program that drives the bench over a pipe (docs/other-languages.md)."),
    ] = None,
    controller_timeout: Annotated[
        float, typer.Option(metavar="S", help="Longest time for an answer of this program, s.")
    ] = 10.0,
    threshold: Annotated[
        str | None,
        typer.Option(metavar="METRIC", help="Find where in the range of --over the claim about this metric holds."),
    ] = None,
    over: Annotated[
        str | None,
        typer.Option(metavar="PATH=LOW:HIGH[:log]", help="The number that --threshold varies, and its range."),
    ] = None,
) -> None:
    """Run a scenario headless; exit code 0: all expectations hold, 1: some do not, 2: invalid input."""
    from scenarios.campaign.single import beside, run_seeds  # each worker process loads this file, and not these
    from scenarios.outside.process import Process
    from scenarios.report.keeping import keep
    from scenarios.report.traces import write_json

    chosen = with_values(load(scenario, units), dict(parse_assignment(text) for text in assign or []))
    if threshold is not None or over is not None:
        _find(chosen if seed is None else with_values(chosen, {"seed": seed}), threshold, over, as_json)
    if seed is not None and seeds is not None:
        raise InputError("give --seed or --seeds, not both", "--seeds")
    if seeds is not None and out is not None:
        raise InputError("traces are written for one seed; use --seed", "--out")
    if seeds is not None and everything:
        raise InputError("is for the trace of one seed; use --seed", "--all")
    if seeds is not None and narrate:
        raise InputError("tells of one seed; use --seed", "--narrate")
    if seeds is not None and controller_process is not None:
        raise InputError("drives one run; use --seed", "--controller-process")
    try:
        with ExitStack() as stack:
            law = None
            if controller_process is not None:
                law = stack.enter_context(Process(controller_process, controller_timeout))
            if seeds is not None:
                summary = run_seeds(chosen, parse_seeds(seeds))
            elif out is None:
                result = run_scenario(chosen, seed, figures_only=True, everything=everything, law=law, narrate=narrate)
                summary = result.summary()
            else:
                stem = out / f"{chosen.id}-seed{chosen.spec.seed if seed is None else seed}"
                with TraceFile(stem.with_suffix(".parquet"), chosen.document) as trace:
                    result = run_scenario(
                        chosen, seed, taps=True, everything=everything, trace=trace, law=law, narrate=True
                    )
                    if law is None:
                        summary = beside(result)
                        keep(result, summary, [result.seed], stem)
                    else:  # no report and no script: they would describe the scenario's own controller
                        summary = result.summary()
                        write_json(stem.with_suffix(".json"), summary)
            if narrate:
                summary["narration"] = [said.model_dump() for said in result.narration]
    except OSError as error:
        folder, field = (temporary_folder(), "TMPDIR") if out is None else (out, "--out")
        raise InputError(f"cannot write to {folder}: {error.strerror}", field) from None
    if as_json:
        say_json(summary)
    else:
        say(run_text(summary))
    raise typer.Exit(0 if summary["ok"] else 1)


def _find(scenario: Scenario, threshold: str | None, over: str | None, as_json: bool) -> None:
    """Find where a claim holds, print it and end: 0 somewhere in the range, 1 nowhere."""
    from server.cli.find import find, threshold_text  # few runs look for a threshold

    if threshold is None or over is None:
        given, missing = ("--over", "--threshold") if threshold is None else ("--threshold", "--over")
        raise InputError(f"goes with {missing}", given)
    found = find(scenario, threshold, over)
    if as_json:
        say_json(found.model_dump())
    else:
        say(threshold_text(found))
    raise typer.Exit(0 if any(one.holds for one in found.tried) else 1)
