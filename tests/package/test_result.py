"""Results of runs from Python, read back by the readers of other people."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import duckdb
import numpy as np
import pytest
import xarray as xr
from scipy.io import loadmat, netcdf_file

import combbench as cb
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import run

SHORT = {"samples": 400}


@pytest.fixture(scope="module")
def result() -> cb.Result:
    return cb.run("first-look", seed=7, set=SHORT)


def test_a_run_has_the_bits_and_figures_of_the_headless_run(result: cb.Result) -> None:
    headless = run(with_values(get("first-look"), SHORT), 7)
    assert (result.digest, result.seed) == (headless.digest, 7)
    assert result.figures == headless.metrics
    for signal in result.signals:
        assert np.array_equal(result.signal(signal.name), headless.trace[signal.name])
    assert [one["metric"] for one in result.expectations()] == [one["metric"] for one in headless.expectations()]


def test_time_is_the_tick_times_the_interval(result: cb.Result) -> None:
    interval = result.scenario.spec.dt_ms
    assert result.time.shape == (400,)
    assert result.time[0] == 0 and result.time[1] == interval
    assert np.array_equal(result.time, np.arange(400) * interval)


def test_taps_are_kept_on_request(result: cb.Result) -> None:
    with_taps = cb.run("first-look", seed=7, set=SHORT, taps=True)
    kinds = {signal.kind for signal in with_taps.signals}
    assert kinds == {"output", "tap"} and {signal.kind for signal in result.signals} == {"output"}
    assert with_taps.digest == result.digest


@pytest.mark.parametrize("name", ["nothing.there", "plant.displacment"])
def test_a_signal_that_is_not_there_is_refused(result: cb.Result, name: str) -> None:
    with pytest.raises(cb.InputError, match="unknown signal"):
        result.signal(name)


def test_xarray_has_time_units_and_the_origin_of_the_data(result: cb.Result) -> None:
    data = result.to_xarray()
    assert isinstance(data, xr.Dataset) and dict(data.sizes) == {"time": 400}
    assert data["time"].attrs["units"] == "ms" and data["time"].attrs["standard_name"] == "time"
    displacement = data["plant.displacement"]
    assert displacement.attrs["units"] == "um" and displacement.attrs["long_name"]
    assert all(one.attrs["units"] for one in data.data_vars.values())
    assert data.attrs["digest"] == result.digest and data.attrs["seed"] == 7
    assert cb.run(json.loads(data.attrs["scenario"]), seed=data.attrs["seed"]).digest == result.digest


def test_pandas_has_a_column_for_each_signal(result: cb.Result) -> None:
    frame = result.to_pandas()
    assert frame.index.name == "time_ms" and list(frame.columns) == [one.name for one in result.signals]
    assert frame.attrs["units"]["plant.displacement"] == "um"
    assert np.array_equal(frame["plant.displacement"].to_numpy(), result.signal("plant.displacement"))


def test_netcdf_is_read_by_its_own_rules(result: cb.Result, tmp_path: Path) -> None:
    path = result.save(tmp_path / "run.nc")
    with netcdf_file(path, "r", mmap=False) as file:
        assert file.Conventions == b"CF-1.11"
        assert file.variables["time"].units == b"ms"
        assert np.array_equal(file.variables["plant.displacement"][:], result.signal("plant.displacement"))


def test_parquet_csv_npz_and_mat_have_every_sample(result: cb.Result, tmp_path: Path) -> None:
    true = result.signal("plant.displacement")
    parquet = result.save(tmp_path / "run.parquet")
    found = duckdb.sql(f"select time_ms, \"plant.displacement\" as x from '{parquet}' order by tick").fetchnumpy()
    assert np.array_equal(found["x"], true) and np.array_equal(found["time_ms"], result.time)
    with result.save(tmp_path / "run.csv").open(newline="") as file:
        assert [float(row["plant.displacement"]) for row in csv.DictReader(file)] == true.tolist()
    with np.load(result.save(tmp_path / "run.npz")) as arrays:
        assert np.array_equal(arrays["plant.displacement"], true)
    variables = loadmat(result.save(tmp_path / "run.mat"), squeeze_me=True)
    names = {str(variables["names"][own]): own for own in variables["names"].dtype.names}
    assert np.array_equal(variables[names["plant.displacement"]], true)
    assert sorted(path.suffix for path in tmp_path.iterdir()) == [".csv", ".mat", ".npz", ".parquet"]


def test_another_ending_is_refused_with_the_endings_that_exist(result: cb.Result, tmp_path: Path) -> None:
    with pytest.raises(cb.InputError, match=r"parquet.*nc"):
        result.save(tmp_path / "run.xlsx")
    with pytest.raises(cb.InputError, match="cannot write"):
        result.save(tmp_path / "nowhere" / "run.csv")
    assert list(tmp_path.iterdir()) == []


def test_a_plot_has_axes_for_each_unit_and_a_line_for_each_signal(result: cb.Result) -> None:
    figure = result.plot("plant.displacement", "drive.voltage", "ideal.displacement")
    top, bottom = figure.axes
    assert (top.get_ylabel(), bottom.get_ylabel(), bottom.get_xlabel()) == ("um", "V", "time, ms")
    assert [line.get_label() for line in top.lines] == ["plant.displacement", "ideal.displacement"]
    assert np.array_equal(bottom.lines[0].get_ydata(), result.signal("drive.voltage"))
    assert [line.get_label() for place in result.plot().axes for line in place.lines] == [
        "plant.displacement",
        "model.displacement",
        "drive.voltage",
    ]
    with pytest.raises(cb.InputError, match="unknown signal"):
        result.plot("nothing")
