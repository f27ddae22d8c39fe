"""One wheel in empty environments of all versions of Python that are here: the same bits, no compiling, the page."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import httpx
import pytest

import combbench

ROOT = Path(__file__).resolve().parents[2]
UV = Path(sys.executable).with_name("uv")
VERSIONS = ("3.11", "3.12", "3.13", "3.14")
SCENARIOS = ("first-look", "gyro-first-look")
OUTSIDE = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "VIRTUAL_ENV")}
"""The environment of a program that knows no checkout."""
PROGRAM = f"""
import json, combbench
from core import kernel_cache
first = combbench.run("{SCENARIOS[0]}")
compiled = list(kernel_cache.compiled_here)
digests = [first.digest, combbench.run("{SCENARIOS[1]}").digest]
first.plot("plant.displacement").savefig("run.png")
unit = first.to_xarray()["plant.displacement"].attrs["units"]
print(json.dumps([digests, compiled, unit, combbench.__file__]))
"""

pytestmark = [pytest.mark.long, pytest.mark.timeout(1800)]


def told(*command: str | Path, cwd: Path = ROOT, **environment: str) -> str:
    """Return the output of a command that succeeds."""
    ended = subprocess.run(
        command, cwd=cwd, env={**OUTSIDE, **environment}, capture_output=True, text=True, check=False
    )
    assert ended.returncode == 0, ended.stderr[-3000:]
    return ended.stdout


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a wheel, built in a copy of the checkout: its machine code would change other tests."""
    copy, out = tmp_path_factory.mktemp("checkout"), tmp_path_factory.mktemp("wheel")
    for name in told("git", "ls-files", "-z").split("\0")[:-1]:
        (copy / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(ROOT / name, copy / name)
    shutil.copytree(ROOT / "web/dist", copy / "web/dist")
    (copy / "web/dist/index.html").touch()
    told(UV, "build", "--wheel", "--no-build-isolation", "--python", sys.executable, "--out-dir", out, cwd=copy)
    (found,) = out.glob("*.whl")
    assert found.name.endswith("-py3-none-any.whl")
    return found


def interpreter(version: str) -> str:
    """Return a Python of a version, of pyenv or another that uv finds, or skip the test."""
    folder = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv")) / "versions"
    for python in folder.glob(f"{version}.*/bin/python"):
        return str(python)
    command = [UV, "python", "find", "--no-python-downloads", "--no-project", version]
    found = subprocess.run(command, cwd="/", env=OUTSIDE, capture_output=True, text=True, check=False)
    if found.returncode:
        pytest.skip(f"this machine has no Python {version}")
    return found.stdout.strip()


@pytest.mark.parametrize("version", VERSIONS)
def test_the_wheel_works_alone(wheel: Path, version: str, tmp_path: Path) -> None:
    python = interpreter(version)
    environment = tmp_path / "environment"
    told(UV, "venv", "--quiet", "--python", python, environment)
    told(UV, "pip", "install", "--quiet", "--python", environment, f"combbench[data] @ {wheel.as_uri()}")
    programs, kept = environment / "bin", {"COMBBENCH_KERNEL_CACHE": str(tmp_path / "kernels")}

    digests, compiled, unit, place = json.loads(told(programs / "python", "-c", PROGRAM, cwd=tmp_path, **kept))
    assert digests == [combbench.run(name).digest for name in SCENARIOS]
    assert (compiled, unit) == ([], "um") and place.startswith(str(environment))
    assert (tmp_path / "run.png").stat().st_size > 10_000
    assert "not built" not in told(programs / "combbench", "doctor", cwd=tmp_path, **kept)
    serve(programs / "combbench", tmp_path, kept)


def serve(program: Path, folder: Path, kept: dict[str, str]) -> None:
    """Serve, open the address that is printed, and stop."""
    settings, command = {**OUTSIDE, **kept, "COMBBENCH_FIGURES": "false"}, [program, "serve", "--port", "0"]
    running = subprocess.Popen(command, cwd=folder, env=settings, stdout=subprocess.PIPE, text=True)
    try:
        assert running.stdout is not None
        address = running.stdout.readline().strip().removeprefix("CombBench is at ")
        with httpx.Client(timeout=120, trust_env=False, follow_redirects=True) as browser:
            page = browser.get(address)
            assert page.status_code == 200 and '<div id="root">' in page.text
            assert browser.get(httpx.URL(address).join("/health/ready")).status_code == 200
        running.terminate()
        assert running.wait(60) == 0
    finally:
        running.kill()
        running.communicate()
