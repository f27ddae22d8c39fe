"""The benchmark as files: what they hold, what hidden ones do not tell, and scores of answers from outside."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from typer.testing import CliRunner

from core.diagnose.mmae import Mmae
from core.errors import InputError
from scenarios.benchmark import seeds
from scenarios.benchmark.answer import answers, section
from scenarios.benchmark.figures import scores
from scenarios.benchmark.measure import measure
from scenarios.benchmark.seeds import SeedList, seed_list
from scenarios.benchmark.track import WARM, WITHIN, tracks
from scenarios.records import benchmark_files
from scenarios.records.benchmark_files import HIDDEN, SAMPLES, export_cases, numbered, read_answer, score_answers
from scenarios.run import run
from server.cli.main import app

TRACK = "known"


def told(track: str, done: int, runs: int) -> None: ...


@pytest.fixture(scope="module")
def few() -> Iterator[SeedList]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(seeds.LISTS, "demonstration", (2, 2))
        yield seed_list("demonstration", (TRACK,))


@pytest.fixture(scope="module")
def public(few: SeedList, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("benchmark") / "cases"
    assert export_cases(folder, [TRACK], few, told) == 4
    return folder / TRACK


def own_answers(folder: Path, few: SeedList) -> None:
    """Write the probabilities of the Kalman bank of the library for every file."""
    (folder / TRACK).mkdir(parents=True)
    track = tracks()[TRACK]
    for name, case in numbered(TRACK, few):
        samples = SAMPLES if name.startswith("case") else case.document["samples"]
        scenario = type(case)(case.seed, {**case.document, "samples": samples}, case.onset, case.truth).scenario(
            {"mmae": section(Mmae, track)}, {}
        )
        result = run(scenario)
        said = {item.name: result.signal(f"mmae.probability.{item.name}") for item in track.hypotheses}
        np.savez(folder / TRACK / f"{name}.npz", **said)  # type: ignore[arg-type]


def test_a_public_case_has_drive_displacement_onset_and_truth(public: Path, few: SeedList) -> None:
    for name, case in numbered(TRACK, few):
        table = pq.read_table(public / f"{name}.parquet")
        about = json.loads(table.schema.metadata[b"combbench"])
        assert about["classes"].keys() == tracks()[TRACK].classes.keys() and about["device"]["mass_mg"] > 0
        if not name.startswith("case"):
            assert table.column_names == ["time", "drive", "displacement"] and table.num_rows == 10_500
            continue
        assert table.column_names == ["time", "drive", "displacement", "onset", "truth"]
        truth = table["truth"].to_numpy()
        assert set(table["onset"].to_numpy().tolist()) == {case.onset}
        assert truth.tolist() == [0] * case.onset + [case.truth] * (SAMPLES - case.onset)
        usual = run(case.scenario({}, {}))
        for column, signal in (("drive", "drive.voltage"), ("displacement", "sensor.displacement")):
            assert np.array_equal(table[column].to_numpy()[: case.onset + WITHIN], usual.signal(signal))


def test_a_hidden_case_tells_nothing_but_what_was_measured(
    public: Path, few: SeedList, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    hidden = SeedList(HIDDEN, few.cases, 1)
    export_cases(tmp_path / "hidden", [TRACK], hidden, told)
    files = sorted((tmp_path / "hidden" / TRACK).glob("case-*"))
    assert [file.name for file in files] == ["case-001.parquet", "case-002.parquet"]
    tables = [pq.read_table(file) for file in files]
    known = [pq.read_table(public / file.name) for file in files]
    cases = dict(numbered(TRACK, hidden))
    for file, table, other in zip(files, tables, known, strict=True):
        case, said = cases[file.stem], json.dumps(json.loads(table.schema.metadata[b"combbench"]))
        assert table.column_names == ["time", "drive", "displacement"] and table.num_rows == SAMPLES
        assert all(table[name].equals(other[name]) for name in table.column_names)
        for secret in (case.seed, str(case.onset), '"onset"', '"truth"', '"seed"', '"events"', '"severity"'):
            assert secret not in said
        meta = pq.ParquetFile(file).metadata
        assert [meta.row_group(i).num_rows for i in range(meta.num_row_groups)] == [SAMPLES]
    keys = {tuple(json.loads(table.schema.metadata[b"combbench"])) for table in tables}
    assert (
        len(keys) == 1 and len({json.loads(table.schema.metadata[b"combbench"])["noise_um"] for table in tables}) == 2
    )


def test_answers_of_the_bank_through_files_have_its_own_figures(few: SeedList, tmp_path: Path) -> None:
    own_answers(tmp_path / "mine", few)
    (row,) = score_answers(tmp_path / "mine", [TRACK], few, told).rows
    (expected,) = measure(["mmae"], [TRACK], few).rows
    assert row.unit == "mine (computed outside)"
    same = set(type(row).model_fields) - {"unit", "digest", "cases"}
    assert {name: getattr(row, name) for name in same} == {name: getattr(expected, name) for name in same}


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda p: {**p, "healthy": p["healthy"][:-1], "m+5": p["m+5"][:-1]}, "has 10499 rows; the run has 10500"),
        (lambda p: {name: value for name, value in p.items() if name != "m+5"}, "has no probability of"),
        (lambda p: {**p, "m+5": np.where(np.arange(len(p["m+5"])) == 7, np.nan, p["m+5"])}, "sample 7, 'm+5': nan"),
        (lambda p: {**p, "m+5": p["m+5"] - 2.0}, "is no probability"),
        (lambda p: {}, "known has no answer healthy-001"),
    ],
)
def test_an_answer_that_does_not_fit_is_named(
    spoil: Callable[[dict[str, Any]], dict[str, Any]], said: str, few: SeedList, tmp_path: Path
) -> None:
    (tmp_path / "bad" / TRACK).mkdir(parents=True)
    names = [item.name for item in tracks()[TRACK].hypotheses]
    spoiled = spoil({name: np.full(10_500, 1.0 / len(names)) for name in names})
    if spoiled:
        np.savez(tmp_path / "bad" / TRACK / "healthy-001.npz", **spoiled)
    with pytest.raises(InputError) as refused:
        score_answers(tmp_path / "bad", [TRACK], few, told)
    assert said in str(refused.value) and "healthy-001" in str(refused.value)


def test_the_command_exports_once_and_marks_rows_from_outside(
    few: SeedList, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(benchmark_files, "_table", lambda *_: pa.table({"time": [0.0]}))

    def call(*args: str) -> Any:
        return CliRunner().invoke(app, ["benchmark", "--track", TRACK, "--seeds", "demonstration", *args])

    assert "4 files in cases" in call("--export", "cases").stdout
    again = call("--export", "cases")
    assert again.exit_code == 2 and "--export: cases is not empty" in again.stderr
    nowhere = call("--answers", "nowhere")
    assert nowhere.exit_code == 2 and "has no folder of a track" in nowhere.stderr
    both = call("--export", "a", "--answers", "b")
    assert both.exit_code == 2 and "goes with --track and --seeds alone" in both.stderr


def filterpy_answers(table: Any) -> dict[str, np.ndarray]:
    """Return the probabilities of filterpy's bank, from nothing but a file: models by the matrix exponential."""
    from filterpy.kalman import KalmanFilter, MMAEFilterBank
    from scipy.linalg import expm

    about = json.loads(table.schema.metadata[b"combbench"])
    drive, measured = table["drive"].to_numpy(), table["displacement"].to_numpy()
    filters = []
    for hypothesis in about["hypotheses"]:
        m, b, k = (
            about["device"][key] * hypothesis.get(name, 1.0)
            for key, name in (("mass_mg", "mass"), ("damping_un_ms_um", "damping"), ("stiffness_un_um", "stiffness"))
        )
        whole = np.array([[0.0, 1.0, 0.0], [-k / m, -b / m, about["device"]["force_un_v"] / m], [0.0, 0.0, 0.0]])
        step = expm(whole * about["dt_ms"])
        one = KalmanFilter(dim_x=2, dim_z=1, dim_u=1)
        one.F, one.B, one.H = step[:2, :2], step[:2, 2:], np.array([[1.0, 0.0]])
        one.Q, one.R = one.B @ one.B.T * 0.3**2, np.array([[about["noise_um"] ** 2]])
        one.x, one.P = np.zeros((2, 1)), np.diag([1.0, k / m * 1e-6])
        filters.append(one)
    n, floor = len(filters), 1e-3
    bank = MMAEFilterBank(filters, [1.0 / n] * n, dim_x=2, H=filters[0].H)
    found = np.empty((len(measured), n))
    for i, value in enumerate(measured.tolist()):
        if i:
            bank.predict(u=np.array([[drive[i - 1]]]))
        bank.update(np.array([[value]]))
        bank.p = np.maximum(np.nan_to_num(bank.p, nan=floor), floor)
        bank.p /= bank.p.sum()
        found[i] = bank.p
    return {hypothesis["name"]: found[:, i] for i, hypothesis in enumerate(about["hypotheses"])}


@pytest.mark.long
@pytest.mark.filterwarnings("ignore")
def test_the_bank_of_filterpy_scores_as_the_bank_of_the_library(public: Path, few: SeedList, tmp_path: Path) -> None:
    said = filterpy_answers(pq.read_table(public / "case-001.parquet"))
    np.savez(tmp_path / "case-001.npz", **said)  # type: ignore[arg-type]
    track, case = tracks()[TRACK], dict(numbered(TRACK, few))["case-001"]
    own = answers(track, case, {"mmae": section(Mmae, track)}, {})["mmae"]
    other = read_answer(tmp_path, "case-001", track, case)
    truth = np.where(np.arange(len(own.evidence)) < case.onset, 0, case.truth)[WARM:]
    found = [scores(np.ascontiguousarray(one.classes[:, WARM:]), truth) for one in (own, other)]  # type: ignore[index]
    print(found)
    assert np.abs(np.subtract(*found)).max() < 0.005
