"""The command for the benchmark of fault diagnosis: measures, prints the table, recomputes submissions."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from core import registry
from core.errors import InputError
from scenarios.own import with_units
from scenarios.reading import read_text
from server.cli.terminal import JsonOption, plainly, say
from server.cli.units import UnitOption


@plainly
def benchmark(
    unit: Annotated[str | None, typer.Argument(help="The diagnoser to measure; without one, all of them.")] = None,
    track: Annotated[str | None, typer.Option(help="Only this track.")] = None,
    seeds: Annotated[
        str, typer.Option(metavar="LIST", help="public, demonstration, or the file with the hidden list.")
    ] = "public",
    check: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Recompute these results and compare them.")
    ] = None,
    export: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Write the cases as files for other tools, and measure nothing.")
    ] = None,
    outside: Annotated[
        Path | None, typer.Option("--answers", metavar="DIR", help="Score probabilities that another tool computed.")
    ] = None,
    units: UnitOption = None,
    as_json: JsonOption = False,
) -> None:
    """Measure diagnosers by mems-diag-1; exit code 0: done, 1: checked results differ, 2: invalid input."""
    from scenarios.benchmark import results as benchmark_results
    from scenarios.benchmark.measure import measure
    from scenarios.benchmark.seeds import LISTS, hidden_list, seed_list
    from scenarios.benchmark.track import track as one_track
    from scenarios.benchmark.track import tracks
    from scenarios.report.benchmark import benchmark_text

    if check is not None and (unit is not None or track is not None or units):
        raise InputError("recomputes what the file has; give neither a unit nor a track", "--check")
    if (export or outside) and (unit is not None or units or check is not None or (export and outside)):
        raise InputError("goes with --track and --seeds alone", "--export" if export else "--answers")
    own = with_units({}, units or ()).get("units", {})
    if track is not None:
        one_track(track)
    names = tuple(tracks())
    chosen = seed_list(seeds, names) if seeds in LISTS else hidden_list(read_text(Path(seeds), "--seeds"), names)

    def told(name: str, done: int, runs: int) -> None:
        if sys.stderr.isatty():
            sys.stderr.write(f"\r{name}: {done} of {runs} runs" + ("\n" if done == runs else ""))

    asked = [track] if track is not None else names
    if export is not None:
        from scenarios.records.benchmark_files import export_cases

        say(f"{export_cases(export, asked, chosen, told)} files in {export}")
        return
    if outside is not None:
        from scenarios.records.benchmark_files import score_answers

        found = score_answers(outside, asked, chosen, told)
        say(benchmark_results.write(found).rstrip() if as_json else benchmark_text(found, tracks()))
        return
    if check is None:
        from scenarios.speed.diagnosers import diagnoser_costs

        named = [unit] if unit is not None else [*own] or [*registry.blocks("diagnose")]
        found = measure(named, asked, chosen, told, own)
        found = found.model_copy(update={"costs": diagnoser_costs({row.unit: None for row in found.rows}, own)})
        if unit is None and not own:
            found = found.without_cases()  # a megabyte
        say(benchmark_results.write(found).rstrip() if as_json else benchmark_text(found, tracks()))
        return
    given = benchmark_results.read(read_text(check, "--check"), "--check")
    if given.seeds != chosen.name:
        raise InputError(f"has results of the list {given.seeds}; name that list, or its file", "--seeds")
    if not given.rows:
        raise InputError("has no rows", "--check")
    if not given.sources:
        raise InputError("has rows computed outside; score their files again with --answers", "--check")
    found = measure([*given.sources], [*{row.track: None for row in given.rows}], chosen, told, given.units)
    differences = given.differences(found)
    if differences and given.version != found.version:
        differences.append(f"they were computed by version {given.version}, these by {found.version}")
    say("\n".join(differences) or f"{len(given.rows)} rows are the same to the bit")
    raise typer.Exit(1 if differences else 0)
