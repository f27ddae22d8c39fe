"""Files that damage, deceive or overfill a reader: name, bytes, and a part of the refusal."""

from __future__ import annotations

import io
import pickle
import struct
import zipfile
import zlib
from collections.abc import Callable, Iterator

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from scipy.io import netcdf_file, savemat

N = 60
RNG = np.random.default_rng(9)
T, U, Y = np.arange(N) * 0.02, RNG.normal(size=N), RNG.normal(size=N)
HEAD = "time_ms,drive,displacement"
ROWS = [",".join(map(repr, row)) for row in zip(T.tolist(), U.tolist(), Y.tolist(), strict=True)]
TEXT = "\n".join([HEAD, *ROWS]) + "\n"
Hostile = tuple[str, bytes, str]


def spoiled(column: int, row: int, word: str, text: str = TEXT) -> bytes:
    """Return the table with another word in a field; row 1 has the names."""
    lines = [line.split(",") for line in text.splitlines()]
    lines[row - 1][column] = word
    return "\n".join(map(",".join, lines)).encode()


def parquet(**columns: object) -> bytes:
    content = io.BytesIO()
    pq.write_table(pa.table(columns), content)
    return content.getvalue()


def mat(**columns: object) -> bytes:
    content = io.BytesIO()
    savemat(content, columns, do_compression=True)
    return content.getvalue()


def npz(**columns: object) -> bytes:
    content = io.BytesIO()
    np.savez_compressed(content, **columns)  # type: ignore[arg-type]
    return content.getvalue()


def netcdf(scale: str = "", **columns: np.ndarray) -> bytes:
    content = io.BytesIO()
    with netcdf_file(content, "w") as file:
        for name, values in columns.items():
            file.createDimension(f"of_{name}", len(values))
            one = file.createVariable(name, "f8", (f"of_{name}",))
            one[:] = values
            if scale:
                one.scale_factor = scale
        file.flush()
        return content.getvalue()


def texts() -> Iterator[Hostile]:
    """Text: 44 files."""
    numeral = {
        "abc": "'abc'", "1.2.3": "'1.2.3'", "1,5;": "fields", "0x1F": "'0x1F'", "--1": "'--1'", "1e": "'1e'",
        "１２": "'１２'", "1_000": "'1_000'", "1 2": "'1 2'", "=1+1": "'=1+1'", "+-3": "'+-3'", "1e+": "'1e+'",
        "\x1b[31mred": "is no number", "\u202e1": "is no number", "∞": "'∞'",
    }  # fmt: skip
    for word, said in numeral.items():
        yield (
            f"{word!r}.csv".replace("/", ""),
            spoiled(2, 9, word),
            said if word == "1,5;" else f"row 9, column 'displacement': {said}" if "'" in said else said,
        )
    yield "quoted comma.csv", spoiled(1, 5, '"1,5"'), "row 5, column 'drive': '1,5' is no number"
    yield (
        "endless displacement.csv",
        spoiled(2, 12, "inf"),
        "row 12, column 'displacement': a displacement must be finite",
    )
    yield "too large.csv", spoiled(2, 12, "1e999"), "row 12, column 'displacement': a displacement must be finite"
    yield "large voltage.csv", spoiled(1, 4, "1e999"), "row 4, column 'drive'"
    yield "no voltage.csv", spoiled(1, 4, "NaN"), "row 4, column 'drive': a voltage must be a finite number"
    yield "no time.csv", spoiled(0, 4, ""), "row 4, column 'time_ms'"
    yield "endless time.csv", spoiled(0, 61, "inf"), "row 61, column 'time_ms'"
    yield "far time.csv", spoiled(0, 61, "1e250"), "most are lost"
    yield "twice a time.csv", spoiled(0, 9, "0.12"), "row 9, column 'time_ms' does not rise"
    yield "falling.csv", spoiled(0, 9, "-7"), "row 9, column 'time_ms' does not rise"
    tiny = [f"{i}e-320,{i},{i}" for i in range(N)]
    yield "tiny times.csv", "\n".join([HEAD, *tiny]).encode(), "rises by"
    yield "large times.csv", "\n".join([HEAD, *(f"{i}e305,1,1" for i in range(N))]).encode(), "rises by"
    yield "blank lines.csv", spoiled(2, 9, "x").replace(b"\n", b"\n\n"), "row 17, column 'displacement': 'x'"
    yield "mixed ends.csv", spoiled(2, 9, "x").replace(b"\n", b"\r\n", 5).replace(b"\n", b"\r", 2), "'x' is no number"
    yield "marked.csv", b"\xef\xbb\xbf" + spoiled(2, 9, "x"), "row 9"
    yield "nothing.csv", b"", "no rows"
    yield "ends of lines.csv", b"\n\r\n\r\n", "no rows"
    yield "mark alone.csv", b"\xef\xbb\xbf", "no rows"
    yield "half a mark.csv", b"\xff\xfe\x41", "UTF-16"
    yield "names.csv", HEAD.encode(), "no rows"
    yield "one row.csv", f"{HEAD}\n0,1,2".encode(), "1 sample"
    yield "zeros.csv", b"\0" * 5000, "zero"
    yield (
        "late zero.csv",
        TEXT.encode() + b"9\0,1,1\n" if len(TEXT) > 65_536 else b"1,2\n" * 20_000 + b"\0,1\n",
        "no column",
    )
    yield (
        "a thousand columns.csv",
        b",".join(b"%d" % i for i in range(1500)) + b"\n" + b",".join([b"1"] * 1500),
        "1500 columns",
    )
    yield "a long line.csv", b"a," * 90_000 + b"\n1\n", "longer than"
    yield "a long row.csv", spoiled(2, 9, "1,2,3,4"), "row 9 has 6 fields, the first has 3"
    yield "an open quote.csv", spoiled(2, 9, '"1'), "row 9"
    yield (
        "labels.csv",
        "\n".join([HEAD + ",label", *(f"{row},w{i}" for i, row in enumerate(ROWS * 2))]).encode(),
        "does not rise",
    )
    yield (
        "long label.csv",
        "\n".join([HEAD + ",label", *(f"{row},{'w' * 999}" for row in ROWS)]).encode(),
        "over 64 characters",
    )


def units() -> Iterator[Hostile]:
    """Names and units of columns: 12 files."""
    for unit in ("kg", "V/m", "degC", "inch", "\x1b[2J"):
        yield (
            f"unit {unit!r}.csv".replace("/", ""),
            TEXT.replace("displacement", f"displacement ({unit})", 1).encode(),
            "allowed: m, mm",
        )
    yield "hours.csv", TEXT.replace("time_ms", "time (h)", 1).encode(), "'h'; allowed: s, ms"
    yield "ampere.csv", TEXT.replace("drive", "drive [mA]", 1).encode(), "'ma'; allowed: v, mv"
    yield "twice.csv", TEXT.replace("drive", "displacement", 1).encode(), "two columns 'displacement'"
    yield "no drive.csv", TEXT.replace("drive", "a", 1).encode(), "no column for the drive"
    yield "empty name.csv", TEXT.replace("displacement", "", 1).encode(), "no column for the displacement"
    yield "page.csv", b"<!doctype html><html>\n<body>\n</body>\n", "record"
    yield "json.csv", b'{"time": [1, 2], "drive": [3, 4]}\n', "record"


def binaries() -> Iterator[Hostile]:
    """Parquet, MAT, NPZ and NetCDF: damaged, deceiving, overfull."""
    good = {
        "parquet": parquet(time_ms=T, drive=U, displacement=Y),
        "mat": mat(time_ms=T, drive=U, displacement=Y),
        "npz": npz(time_ms=T, drive=U, displacement=Y),
        "nc": netcdf(time_ms=T, drive=U, displacement=Y),
    }
    for kind, content in good.items():
        yield f"nothing.{kind}", b"", "record"
        yield f"half.{kind}", content[: len(content) // 2], "record"
        yield f"head alone.{kind}", content[:16], "record"
        yield f"text.{kind}", TEXT.encode(), "cannot be read as"
        yield f"pickle.{kind}", pickle.dumps({"time": [1.0]}), "cannot be read as"
        words = np.array(["a", "b"] * (N // 2))
        write: Callable[..., bytes] = {"parquet": parquet, "mat": mat, "npz": npz}.get(kind, netcdf)
        if kind != "nc":
            yield f"words.{kind}", write(time_ms=T, drive=words, displacement=Y), "column 'drive'"
        yield f"one sample.{kind}", write(time_ms=T[:1], drive=U[:1], displacement=Y[:1]), "record"
        yield f"a time twice.{kind}", write(time_ms=np.r_[T[:-1], T[3]], drive=U, displacement=Y), "does not rise"
        if kind != "parquet":
            yield f"uneven.{kind}", write(time_ms=T, drive=U[:-1], displacement=Y), "has 59 rows"
    flipped = bytearray(good["parquet"])
    flipped[40:60] = b"\xff" * 20
    yield "a damaged page.parquet", bytes(flipped), "record"
    yield (
        "a footer of 2 GB.parquet",
        good["parquet"][:-8] + struct.pack("<I", 2**31 - 1) + b"PAR1",
        "cannot be read as Parquet",
    )
    yield "many columns.parquet", parquet(**{f"c{i}": [1.0] for i in range(1500)}), "1500 columns"
    yield (
        "lists.parquet",
        parquet(time_ms=T, drive=[[1.0]] * N, displacement=Y),
        "column 'drive'",
    )
    yield "many rows.parquet", parquet(time_ms=np.zeros(120_000)), "120000 rows; at most 100000"
    head = good["mat"][:128]
    yield "an element of 2 GB.mat", head + struct.pack("<II", 14, 2**31 - 1) + b"\0" * 64, "announces 2147483647 bytes"
    yield "a packed bomb.mat", head + packed_zeros(), "unpacks to more than"
    yield "objects.mat", mat(time_ms=T, drive=np.array([{"a": 1}] * N, dtype=object), displacement=Y), "record"
    yield "structures.mat", mat(record={"time": T, "drive": U, "displacement": Y}), "no vectors"
    yield "pickles.npz", npz(time=np.array([{"a": 1}], dtype=object), drive=U), "no column for the displacement"
    yield "a head of 2 GB.npz", npy_bomb(2**28), "rows; at most"
    yield "fewer numbers.npz", npy_bomb(50_000), "announces 50000 numbers and has fewer"
    yield "no arrays.npz", zipped("a.txt", b"text"), "cannot be read as NPZ"
    yield "a dimension of 2 GB.nc", good["nc"].replace(struct.pack(">I", N), struct.pack(">I", 2**31 - 1)), "record"
    yield "a scale in words.nc", netcdf("twice", time_ms=T, drive=U, displacement=Y), "cannot be read as NetCDF"
    yield "a table.xlsx", zipped("xl/workbook.xml", b"<x/>"), "unknown kind of file '.xlsx'"
    yield "no ending", TEXT.encode(), "unknown kind of file"


def packed_zeros() -> bytes:
    """Return an element that unpacks to 16 MB."""
    packer = zlib.compressobj(9)
    content = b"".join([*(packer.compress(bytes(1 << 20)) for _ in range(16)), packer.flush()])
    return struct.pack("<II", 15, len(content)) + content


def npy_bomb(samples: int) -> bytes:
    """Return an array that announces more numbers than it has."""
    head = io.BytesIO()
    np.lib.format.write_array_header_1_0(head, {"descr": "<f8", "fortran_order": False, "shape": (samples,)})
    return zipped("drive.npy", head.getvalue() + bytes(80))


def zipped(name: str, content: bytes) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as file:
        file.writestr(name, content)
    return packed.getvalue()


def hdf5() -> Iterator[Hostile]:
    """HDF5, with the package that writes it."""
    import h5py

    def file_of(fill: Callable[[h5py.File], object]) -> bytes:
        content = io.BytesIO()
        with h5py.File(content, "w") as file:
            fill(file)
        return content.getvalue()

    def usual(file: h5py.File) -> None:
        for name, values in (("time_ms", T), ("drive", U), ("displacement", Y)):
            file[name] = values

    good = file_of(usual)
    yield "nothing.h5", b"", "cannot be read as HDF5"
    yield "half.h5", good[: len(good) // 2], "cannot be read as HDF5"
    yield "text.h5", TEXT.encode(), "cannot be read as HDF5"
    yield "a terabyte.h5", file_of(lambda file: file.create_dataset("drive", (2**37,), "f8", chunks=(1024,))), "at most"
    yield (
        "another file.h5",
        file_of(lambda file: file.__setitem__("drive", h5py.ExternalLink("/etc/hostname", "/"))),
        "no vectors",
    )
    outside = [("/etc/hostname", 0, h5py.h5f.UNLIMITED)]
    yield (
        "raw bytes.h5",
        file_of(lambda file: file.create_dataset("drive", (8,), "u1", external=outside)),
        "is in another file",
    )
    yield "many.h5", file_of(lambda file: [file.__setitem__(f"c{i}", [1.0, 2.0]) for i in range(1100)]), "1001 columns"
    yield "matrices.h5", file_of(lambda file: file.__setitem__("drive", np.zeros((9, 9)))), "no vectors"
