"""Files of records: what is read, and what is refused in one line."""

from __future__ import annotations

import io

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from scipy.io import netcdf_file, savemat

from core.errors import InputError
from scenarios.records.reading import ReadRecord, read_record

RNG = np.random.default_rng(5)
N = 60
T, U, Y = np.arange(N) * 0.02, RNG.normal(size=N), RNG.normal(size=N)
HEAD = "time_ms,drive,displacement"


def text(head: str = HEAD, sep: str = ",", decimal: str = ".", columns: tuple[np.ndarray, ...] = (T, U, Y)) -> str:
    rows = [sep.join(repr(float(value)).replace(".", decimal) for value in row) for row in zip(*columns, strict=True)]
    return "\n".join([head.replace(",", sep), *rows] if head else rows) + "\n"


def read(content: str | bytes, name: str = "a.csv", **more: object) -> ReadRecord:
    return read_record(content.encode() if isinstance(content, str) else content, name, **more)  # type: ignore[arg-type]


def netcdf(*columns: tuple[str, str, np.ndarray]) -> bytes:
    """Return a NetCDF file."""
    content = io.BytesIO()
    with netcdf_file(content, "w") as file:
        file.createDimension("time", N)
        for name, unit, values in columns:
            one = file.createVariable(name, "f8", ("time",))
            one[:], one.units = values, unit
        file.flush()
        return content.getvalue()


def test_labels_and_gaps_of_netcdf_and_scaled_numbers_are_read() -> None:
    content = io.BytesIO()
    with netcdf_file(content, "w") as file:
        for name, count in (("time", N), ("letters", 8)):
            file.createDimension(name, count)
        for name, values in (("t_ms", T), ("u", U)):
            file.createVariable(name, "f8", ("time",))[:] = values
        y = file.createVariable("y_nm", "i2", ("time",))
        y[:], y.scale_factor, y.add_offset, y._FillValue = np.arange(N), 2.0, 1.0, np.int16(7)
        file.createVariable("label", "S1", ("time", "letters"))[:] = [list("healthy".ljust(8, "\0"))] * N
        file.flush()
        found = read(content.getvalue(), "a.nc")
    expected = (np.arange(N) * 2.0 + 1.0) / 1e3
    expected[7] = np.nan
    assert np.allclose(found.record.displacement, expected, rtol=1e-15, equal_nan=True)
    assert found.record.hypotheses == ("healthy",) and found.notes == ["1 sample is lost"]


def test_hdf5_files_give_the_same_bits(monkeypatch: pytest.MonkeyPatch) -> None:
    h5py = pytest.importorskip("h5py")
    content = io.BytesIO()
    with h5py.File(content, "w") as file:
        for name, unit, values in (("run/time", "ms", T), ("run/drive", "V", U), ("run/y", "um", Y)):
            file.create_dataset(name, data=values, compression="gzip").attrs["units"] = unit
    named = {"time": "run/time", "drive": "run/drive", "displacement": "run/y"}
    keys = {read(content.getvalue(), name, named=named).record.key for name in ("a.h5", "a.hdf5", "a.nc")}
    assert keys == {read(text()).record.key}


def test_hdf5_without_its_package_is_one_clear_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("scenarios.extras.find_spec", lambda _: None)
    with pytest.raises(InputError, match="needs the package h5py, which is not installed") as refused:
        read(b"\x89HDF\r\n\x1a\n", "a.h5")
    assert ".[files]" in str(refused.value) or ".[files]" in refused.value.hint


GOOD = {
    "commas": text(),
    "semicolons and decimal commas": text(sep=";", decimal=","),
    "tabs": text(sep="\t"),
    "spaces": text(sep="  "),
    "a byte order mark": "\ufeff" + text(),
    "ends of lines of Windows": text().replace("\n", "\r\n"),
    "mixed ends of lines": text().replace("\n", "\r\n", 9),
    "UTF-16": text().encode("utf-16"),
    "a micro sign of Latin-1": text("time (ms),drive (V),displacement (µm)").encode("latin-1"),
    "a line of units": "# scope\n\nTime,Drive,Displacement\n(ms),(V),(um)\n" + text(""),
    "units in brackets": text("t [ms],Vd (V),y [um]"),
    "empty lines": text().replace("\n", "\n\n"),
    "a column too many": text(HEAD + ",more", columns=(T, U, Y, Y)),
    "quotes": text().replace(HEAD, '"time_ms","drive","displacement"'),
}


@pytest.mark.parametrize("content", GOOD.values(), ids=GOOD)
def test_forms_of_text_give_the_same_bits(content: str | bytes) -> None:
    found = read(content).record
    assert found.rate_khz == 50.0
    assert np.array_equal(found.drive, U) and np.array_equal(found.displacement, Y)


def test_files_with_types_give_the_same_bits() -> None:
    table = io.BytesIO()
    pq.write_table(pa.table({"time_ms": T, "drive.voltage": U, "sensor.displacement": Y}), table)
    matrix = io.BytesIO()
    savemat(matrix, {"t_ms": T, "u": U, "y": Y})
    packed = io.BytesIO()
    np.savez_compressed(packed, time_ms=T, drive=U, displacement=Y)
    contents = {"a.parquet": table.getvalue(), "a.mat": matrix.getvalue(), "a.npz": packed.getvalue()}
    contents |= {"a.nc": netcdf(("time", "ms", T), ("drive", "V", U), ("displacement", "um", Y))}
    keys = {read(content, name).record.key for name, content in contents.items()}
    assert keys == {read(text()).record.key}


def test_units_are_converted_and_columns_are_named() -> None:
    found = read(
        text("zeit (s),Vd [mV],weg (nm)", columns=(T / 1e3, U * 1e3, Y * 1e3)),
        named={"time": "zeit (s)", "displacement": "weg (nm)"},
    )
    assert found.columns == {"time": "zeit (s)", "displacement": "weg (nm)", "drive": "Vd [mV]"}
    assert found.record.rate_khz == pytest.approx(50.0, rel=1e-8)
    assert np.allclose(found.record.displacement, Y, rtol=1e-14) and np.allclose(found.record.drive, U, rtol=1e-14)


def test_a_file_without_times_needs_a_rate() -> None:
    content = text("drive,displacement", columns=(U, Y))
    assert read(content, rate_khz=25.0).record.rate_khz == 25.0
    with pytest.raises(InputError, match="no column of times"):
        read(content)


def test_rows_that_were_lost_are_lost_samples() -> None:
    keep = np.delete(np.arange(N), [5, 6, 40])
    found = read(text(columns=(T[keep], U[keep], Y[keep])))
    assert found.record.samples == N and found.notes == ["3 samples are lost"]
    assert np.flatnonzero(np.isnan(found.record.displacement)).tolist() == [5, 6, 40]
    assert found.record.drive[6] == U[4] and found.record.drive[7] == U[7]


def test_irregular_times_are_interpolated_and_long_gaps_stay_lost() -> None:
    t = np.delete(T + RNG.uniform(-0.006, 0.006, N), [30, 31, 32, 33])
    found = read(text(columns=(t, np.sin(t), 2 * t)))
    line = found.record.displacement - 2 * (t[0] + np.arange(found.record.samples) / found.record.rate_khz)
    assert "irregular" in found.notes[0] and found.record.rate_khz == pytest.approx(50.0, rel=0.05)
    assert 3 <= np.isnan(line).sum() <= 6 and np.nanmax(np.abs(line)) < 1e-12


def test_a_voltage_that_acted_until_the_sample_is_moved() -> None:
    found = read(text(), pairing="last").record
    assert np.array_equal(found.drive, U[1:]) and np.array_equal(found.displacement, Y[:-1])


def test_labels_are_words_or_numbers_or_none() -> None:
    words = ["", "healthy", "m+5"] * 20
    rows = text().splitlines()
    content = "\n".join([rows[0] + ",label", *(f"{row},{word}" for row, word in zip(rows[1:], words, strict=True))])
    found = read(content).record
    assert found.hypotheses == ("healthy", "m+5") and found.label is not None
    assert found.label[:6].tolist() == [-1, 0, 1, -1, 0, 1]


def spoiled(column: int, row: int, word: str) -> str:
    rows = [line.split(",") for line in text().splitlines()]
    rows[row][column] = word
    return "\n".join(map(",".join, rows))


HOSTILE = {
    "nothing": ("", "no rows"),
    "names alone": (HEAD + "\n", "no rows"),
    "one row": (HEAD + "\n0,1,2\n", "1 sample"),
    "bytes": (b"\x00\x01\x02" * 99, "zero"),
    "a long line": ("x" * 100_000, "longer than"),
    "one column": ("drive\n1\n2\n3\n", "one column"),
    "words in numbers": (spoiled(2, 7, "abc"), "row 8, column 'displacement': 'abc' is no number"),
    "a lost voltage": (spoiled(1, 7, ""), "row 8, column 'drive'"),
    "an endless voltage": (spoiled(1, 9, "inf"), "row 10, column 'drive'"),
    "a short row": (text().replace(f",{float(Y[7])!r}", ""), "row 9 has 2 fields"),
    "a time twice": (text(columns=(np.sort(np.r_[T[:-1], T[5]]), U, Y)), "does not rise"),
    "a time that falls": (text(columns=(T[::-1], U, Y)), "does not rise"),
    "a time that is no number": (spoiled(0, 3, "nan"), "row 4, column 'time_ms': a time must be a finite number"),
    "a wrong unit": (text("t (ms),drive (V),displacement (kg)"), "'kg'; allowed: m, mm"),
    "two of a name": (text("time_ms,drive,drive"), "two columns"),
    "no displacement": (text("time_ms,drive,b"), "no column for the displacement"),
    "no names": (text(""), "no column for the drive"),
    "two decimal signs": (text(sep=";").replace(f"{float(U[3])!r}", "1,5", 1), "decimal sign"),
    "mostly lost": (text(columns=(np.r_[T[:-1], 900.0], U, Y)), "most are lost"),
    "no displacement at all": (text(columns=(T, U, Y * np.nan)), "no finite number"),
}


@pytest.mark.parametrize(("content", "said"), HOSTILE.values(), ids=HOSTILE)
def test_a_hostile_file_is_refused_in_one_line(content: str | bytes, said: str) -> None:
    with pytest.raises(InputError) as refused:
        read(content)
    line = str(refused.value)
    assert said in line and "\n" not in line and len(line) < 300


@pytest.mark.parametrize("name", ["a.parquet", "a.mat", "a.nc", "a.xyz", "record"])
def test_a_file_that_is_not_its_kind_is_refused_in_one_line(name: str) -> None:
    with pytest.raises(InputError) as refused:
        read(b"PAR1 or nothing", name)
    assert "\n" not in str(refused.value)


def test_a_map_that_names_no_column_lists_the_columns() -> None:
    with pytest.raises(InputError, match="unknown column 'Vd'"):
        read(text(), named={"drive": "Vd"})
    with pytest.raises(InputError, match="unknown part 'force'"):
        read(text(), named={"force": "drive"})
