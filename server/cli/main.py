"""The command line: ``combbench``, followed by a command; without one it lists them."""

from __future__ import annotations

import errno
import fnmatch
import os
import sys
from contextlib import ExitStack
from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

import scenarios  # noqa: F401  (first: it gives compiled kernels their cache)
from core.cards import BlockCard
from core.errors import InputError, one_line
from core.format import format_short, unit_text
from core.registry import catalog
from scenarios.library import get, ids
from scenarios.report.text import gallery_text
from scenarios.run import run as run_scenario
from server.cli.bench import bench
from server.cli.benchmark import benchmark
from server.cli.diagnose import diagnose_file
from server.cli.export import export, fmu
from server.cli.games import game
from server.cli.instrument import instrument
from server.cli.lessons import lectures, sheets
from server.cli.replay import replay
from server.cli.run import run
from server.cli.schema import schema
from server.cli.terminal import JsonOption, plainly, say, say_json
from server.cli.units import UnitOption, check
from server.version import VERSION

UsageError: Any = typer.BadParameter.__base__
"""Every usage error of options and arguments; Typer exports only one kind of them."""


class OneLine(TyperGroup):
    """Commands that report usage errors in one line, like all bad input."""

    def invoke(self, ctx: typer.Context) -> Any:  # type: ignore[override]
        """Invoke a command; a usage error is exit code 2."""
        try:
            return super().invoke(ctx)
        except UsageError as error:
            parameter = getattr(error, "param", None)
            where = f"{parameter.opts[0]}: " if parameter is not None and error.message else ""
            text = error.message if where else error.format_message()
            sys.stderr.write(f"combbench: {where}{one_line(text)}\n")
            raise typer.Exit(2) from None


app = typer.Typer(cls=OneLine, no_args_is_help=True, add_completion=False, pretty_exceptions_enable=False)
app.command()(run)
app.command()(replay)
app.command("diagnose")(diagnose_file)
app.command()(instrument)
app.command()(fmu)
app.command()(export)
app.command()(bench)
app.command()(benchmark)
app.command()(lectures)
app.command()(sheets)
app.command()(check)
app.command()(game)
app.command()(schema)

MOST_WORKERS = 1024
NOT_WRITTEN = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EPIPE)
"""Errors of a write to an open file."""


def show_version(wanted: bool) -> None:
    """Print the version and end."""
    if wanted:
        say(f"combbench {VERSION}")
        raise typer.Exit


@app.callback()
def common(
    version: Annotated[
        bool, typer.Option("--version", callback=show_version, is_eager=True, help="Print the version and end.")
    ] = False,
) -> None:
    """Run, measure and serve MEMS lateral comb resonators."""


@app.command()
@plainly
def gallery(
    only: Annotated[str, typer.Option(metavar="GLOB", help="Only ids that match.")] = "*",
    as_json: JsonOption = False,
) -> None:
    """Run every library scenario: claim, expectation, measured figure, verdict, and the figure of the open loop."""
    from scenarios.campaign.single import beside

    chosen = [get(name) for name in ids() if fnmatch.fnmatch(name, only)]
    if not chosen:
        raise InputError(f"no scenario matches {only!r}", "--only")
    summaries = [beside(run_scenario(entry, figures_only=True)) for entry in chosen]
    if as_json:
        say_json(summaries)
    else:
        say("\n".join(gallery_text(summary) for summary in summaries))
    raise typer.Exit(0 if all(summary["ok"] for summary in summaries) else 1)


@app.command()
@plainly
def sweep(
    file: Annotated[Path, typer.Argument(help="Campaign in TOML.")],
    workers: Annotated[
        int | None, typer.Option(help="Processes of this machine, 1 to 1024; without it, as many as it has processors.")
    ] = None,
    scheduler: Annotated[
        str | None,
        typer.Option(
            metavar="ADDRESS", help="Address of a Dask scheduler in place of processes, such as tcp://host:8786."
        ),
    ] = None,
    out: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Folder of the results; without it, sweeps/ID.")
    ] = None,
    resume: Annotated[bool, typer.Option("--resume", help="Continue the campaign in the folder.")] = False,
    units: UnitOption = None,
) -> None:
    """Run a campaign; exit code 0: every run was carried out, 1: some were not, 2: invalid input."""
    from scenarios.campaign.campaign import Stopped
    from scenarios.campaign.executor import collect_seldom
    from server.cli.sweep import carry_out, read_sweep
    from server.settings import load_settings

    if workers is not None and scheduler is not None:
        raise InputError("give --workers or --scheduler, not both", "--scheduler")
    if workers is not None and not 1 <= workers <= MOST_WORKERS:
        raise InputError(f"must be from 1 to {MOST_WORKERS}, got {workers}", "--workers")
    collect_seldom()
    campaign = read_sweep(file, units or ())
    folder = out or Path("sweeps") / campaign.head.id
    address = load_settings().database_url
    given = "".join(f" --unit {one}" for one in units or ())
    again = f"; continue with: combbench sweep {file} --out {folder} --resume{given}"
    try:
        with ExitStack() as stack:
            bars: list[Any] = []  # no progress bar before the first run: a refusal is one line

            def show(done: int, total: int) -> None:
                if not bars:
                    bar = typer.progressbar(length=total, label=campaign.head.id, file=sys.stderr)
                    bars.append(stack.enter_context(bar))
                bars[0].update(done - bars[0].pos)

            ended = carry_out(campaign, folder, address, resume, workers or os.cpu_count() or 1, scheduler or "", show)
    except Stopped as error:
        sys.stderr.write(f"combbench: {error}{again}\n")
        raise typer.Exit(1) from None
    except KeyboardInterrupt:
        sys.stderr.write(f"combbench: interrupted{again}\n")
        raise typer.Exit(130) from None
    for text in ended.warnings:
        sys.stderr.write(f"combbench: warning: {text}\n")
    say(f"{ended.done} of {ended.total} runs, {ended.failed} could not be carried out; {ended.folder}/report.html")
    raise typer.Exit(1 if ended.failed or ended.done < ended.total else 0)


@app.command(name="catalog")
@plainly
def blocks(
    family: Annotated[str | None, typer.Argument(help="Only this family.")] = None,
    as_json: JsonOption = False,
) -> None:
    """List every block: parameters with unit, range, default, meaning, equations."""
    cards = catalog(family)
    if as_json:
        say_json([card.model_dump() for card in cards])
        return
    for card in cards:
        _show(card)
        say()


def _show(card: BlockCard) -> None:
    """Print a block for people."""
    say(f"{card.family}/{card.name}: {card.title}")
    say(f"  {card.summary}")
    for weakness in card.weaknesses:
        say(f"  Known weakness: {weakness}")
    for equation in card.equations:
        say(f"  {equation.label}: {equation.latex}" + (f"   [{equation.source}]" if equation.source else ""))
    for entry in card.parameters:
        bounds = (entry.minimum, entry.maximum)
        limits = " .. ".join("" if bound is None else format_short(bound, "", 6) for bound in bounds)
        live = "live" if entry.live else "at reset"
        allowed = (
            f" one of {', '.join(entry.choices)}" if entry.choices else f" [{limits}]" if limits.strip(" .") else ""
        )
        default = (
            "auto" if entry.default is None else entry.default if not isinstance(entry.default, list | dict) else "..."
        )
        say(f"    {entry.name} = {default} {unit_text(entry.unit)}{allowed} ({live}): {entry.meaning}")


@app.command()
@plainly
def serve(
    host: Annotated[
        str | None,
        typer.Option(help="Address on which the server listens; beyond this machine it needs a token or --classroom."),
    ] = None,
    port: Annotated[int | None, typer.Option(help="Port on which the server listens; 0 chooses a free one.")] = None,
    data: Annotated[Path | None, typer.Option(help="Folder for database and recordings.")] = None,
    classroom: Annotated[
        bool, typer.Option("--classroom", help="Serve a class on this network: students join by a code, without TLS.")
    ] = False,
    open_page: Annotated[bool, typer.Option("--open", help="Open the page in a browser.")] = False,
    units: UnitOption = None,
) -> None:
    """Serve the page."""
    from server.cli.serve import serve as start
    from server.settings import load_settings

    flags = {"classroom": classroom or None, "open_page": open_page or None, "unit_files": units or None}
    start(load_settings(host=host, port=port, data=data, **flags))


@app.command()
@plainly
def doctor(as_json: JsonOption = False) -> None:
    """Show the effective settings with their sources, versions, and the state of the kernel cache."""
    from server.cli.doctor import examine

    report = examine()
    if as_json:
        say_json(report)
        return
    for title, entries in report.items():
        say(title)
        for name, value in entries.items():
            say(f"  {name:<28} {value}")


def main() -> None:
    """Run the command line; one line also reports an answer that cannot be written, as on a full disk."""
    for number in (1, 2):  # the next file opened would take the number of a closed one
        try:
            os.fstat(number)
        except OSError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), number)
    sys.stdout, sys.stderr = sys.stdout or Path(os.devnull).open("w"), sys.stderr or Path(os.devnull).open("w")
    try:
        try:
            app()
        finally:
            sys.stdout.flush()
    except OSError as error:
        if error.errno not in NOT_WRITTEN or error.filename is not None:
            raise
        # Python would try at its end to write the rest again.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if isinstance(error, BrokenPipeError):  # the reader has closed the pipe
            sys.exit(1)
        sys.stderr.write(f"combbench: cannot write to standard output: {error.strerror}\n")
        sys.exit(2)


if __name__ == "__main__":
    main()
