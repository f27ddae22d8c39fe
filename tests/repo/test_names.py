"""A step that misspells a name does not pass the type checker."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from core.block import Block
from core.control.controller import ControllerPorts
from core.record import Record

ROOT = Path(__file__).resolve().parents[2]

UNIT = '''
"""A proportional law."""

from __future__ import annotations

from core.block import Block, BlockParams, parameter
from core.control.controller import ControllerPorts
from core.ports import tap
from core.record import Record, Vector, vector


class Proportional(Block):
    """Proportional to the error."""

    title = "Proportional"

    class Params(BlockParams):
        """The gain."""

        gain: float = parameter(1.0, "gain", "V/um")

    class Packed(Record):
        """The gain."""

        gain: float

    class State(Record):
        """The last errors."""

        last: Vector = vector(2)

    class Ports(ControllerPorts):
        """The error."""

        error: float = tap("um", "model minus measured displacement")

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Compute one sample."""
        x.error = x.model - x.measured
        s.last[0] = x.error
        x.voltage = p.gain * s.last[0]
'''


def checked(*paths: Path) -> str:
    command = [sys.executable, "-m", "mypy", "--no-error-summary", "--follow-imports", "silent", *map(str, paths)]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False).stdout


@pytest.mark.long
def test_a_misspelt_port_parameter_or_state_is_an_error_before_anything_runs(tmp_path):
    right, wrong = tmp_path / "proportional.py", tmp_path / "misspelt.py"
    right.write_text(UNIT)
    misspelt = UNIT.replace("x.model - x.measured", "x.model - x.mesured").replace("p.gain *", "p.gian *")
    wrong.write_text(misspelt.replace("s.last[0] = x", "s.lost[0] = x").replace("x.voltage =", "x.volts ="))
    found = checked(right, wrong)
    for name in ("mesured", "gian", "lost", "volts"):
        assert f'has no attribute "{name}"' in found
    assert all("misspelt.py" in line for line in found.splitlines()), found


def test_no_base_of_ports_parameters_or_states_allows_any_name():
    """The type checker would pass every name of a class that has ``__getattr__``."""
    bases = {base for kind in (Record, Block, ControllerPorts) for base in kind.__mro__}
    assert [base for base in bases if "__getattr__" in vars(base) or "__getattribute__" in vars(base)] == [object]
