"""The folder of compiled kernels: used kernels stay, unused kernels are deleted."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest

from scenarios import kernels
from scenarios.kernel_cache import Folder, folder, prune

DAY_S = 24 * 3600.0


def keep(path: Path, name: str, days: float) -> Path:
    file = path / name
    file.write_bytes(b"code")
    os.utime(file, (time.time() - days * DAY_S,) * 2)
    return file


def names(path: Path) -> set[str]:
    return {file.name for file in path.iterdir()}


def test_kernels_nobody_has_used_for_a_month_are_deleted(tmp_path):
    for name, days in (("new", 0), ("recent", 29), ("old", 31), ("tmp-of-a-process-that-died", 31)):
        keep(tmp_path, name, days)
    prune(tmp_path)
    assert names(tmp_path) == {"new", "recent"}


def test_a_kernel_that_is_used_stays(tmp_path):
    keep(tmp_path, "used", 31)
    keep(tmp_path, "unused", 31)
    assert Folder(tmp_path).get("used") == b"code"
    prune(tmp_path)
    assert Folder(tmp_path).get("used") == b"code"
    assert Folder(tmp_path).get("unused") is None


@pytest.mark.parametrize(("days", "left"), [(31, set()), (29, {"complete-other", "kernel"})])
def test_no_other_version_counts_as_complete_once_a_kernel_is_gone(tmp_path, days, left):
    keep(tmp_path, "complete-other", 1)
    keep(tmp_path, "kernel", days)
    prune(tmp_path)
    assert names(tmp_path) == left


@pytest.mark.parametrize("slow", ["stat", "unlink"])
def test_a_file_another_process_has_deleted_is_no_error(tmp_path, monkeypatch, slow):
    keep(tmp_path, "gone", 31)
    keep(tmp_path, "old", 31)
    plain = getattr(Path, slow)

    def raced(self: Path, **options):
        if self.name == "gone":
            self.parent.joinpath("gone").touch()
            os.unlink(self)
        return plain(self, **options)

    monkeypatch.setattr(Path, slow, raced)
    prune(tmp_path)
    assert names(tmp_path) == set()


@pytest.mark.parametrize(
    ("terminal", "said"),
    [
        (False, ["10 of 21\n", "20 of 21\n", "21 of 21, "]),
        (True, [*(f"{count} of 21" for count in range(1, 21)), "21 of 21, "]),
    ],
)
def test_a_log_gets_a_line_now_and_then_and_a_terminal_one_that_changes(tmp_path, monkeypatch, capsys, terminal, said):
    keep(tmp_path, "old", 31)
    monkeypatch.setattr(kernels, "compile_all", lambda work, told, **_: [told(count, 21) for count in range(1, 22)])
    monkeypatch.setattr(kernels, "complete", lambda: tmp_path / "complete-this")
    monkeypatch.setattr("sys.stdout.isatty", lambda: terminal)
    kernels.main()
    written = capsys.readouterr().out
    assert written.count("\r") == (21 if terminal else 0)
    assert written.count("\n") == (1 if terminal else 3)
    assert written.endswith(" s\n")
    parts = written.split("Compiling kernels: ")[1:]
    assert len(parts) == len(said)
    assert all(part.startswith(text) for part, text in zip(parts, said, strict=True))
    assert names(tmp_path) == {"complete-this"}


@pytest.mark.skipif(os.name != "posix", reason="this system has other rights")
@pytest.mark.parametrize(("rights", "is_refused"), [(0o700, False), (0o755, False), (0o775, True), (0o757, True)])
def test_a_folder_that_others_can_write_to_is_refused(tmp_path, monkeypatch, rights, is_refused):
    kept = tmp_path / "kernels"
    kept.mkdir()
    kept.chmod(rights)
    monkeypatch.setenv("COMBBENCH_KERNEL_CACHE", str(tmp_path))
    assert folder.__wrapped__() == (None if is_refused else kept)
    monkeypatch.setattr(os, "getuid", lambda: os.stat(kept).st_uid + 1)
    assert folder.__wrapped__() is None
