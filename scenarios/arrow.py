"""pyarrow, loaded when something of it is used: most starts and runs write and read no trace."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pyarrow as pa
    import pyarrow.compute as pc
    import pyarrow.csv as csv
    import pyarrow.parquet as pq
else:

    class Later:
        """A module that is loaded when one of its names is asked for."""

        def __init__(self, name: str) -> None:
            self._name = name

        def __getattr__(self, name: str) -> Any:
            return getattr(import_module(self._name), name)

    pa, pc, csv, pq = (Later(f"pyarrow{part}") for part in ("", ".compute", ".csv", ".parquet"))

__all__ = ["csv", "pa", "pc", "pq"]
