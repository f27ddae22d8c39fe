"""Log lines: readable in a terminal, JSON in a container."""

from __future__ import annotations

import json
import logging
import sys
from datetime import UTC, datetime

from server.settings import Settings

STANDARD = frozenset(vars(logging.makeLogRecord({})))


class JsonFormatter(logging.Formatter):
    """One JSON object per line."""

    def format(self, record: logging.LogRecord) -> str:
        """Format a record with whatever was added to it."""
        line = {
            "at": datetime.fromtimestamp(record.created, UTC).isoformat(timespec="milliseconds"),
            "level": record.levelname,
            "logger": record.name,
            "message": record.getMessage(),
        }
        line |= {name: value for name, value in vars(record).items() if name not in STANDARD}
        if record.exc_info:
            line["exception"] = self.formatException(record.exc_info)
        return json.dumps(line, default=str)


class WithoutToken(logging.Filter):
    """Drops the access token from the lines of the web server."""

    def filter(self, record: logging.LogRecord) -> bool:
        """Hide everything behind ``token=``."""
        if isinstance(record.args, tuple):
            record.args = tuple(
                value.partition("token=")[0] + "token=..." if isinstance(value, str) and "token=" in value else value
                for value in record.args
            )
        return True


def configure(settings: Settings) -> None:
    """Send all log lines of the process to standard error."""
    as_json = settings.log_format == "json" or (settings.log_format == "auto" and not sys.stderr.isatty())
    handler = logging.StreamHandler(sys.stderr)
    text = logging.Formatter("%(asctime)s %(levelname)-7s %(name)s  %(message)s", "%H:%M:%S")
    handler.setFormatter(JsonFormatter() if as_json else text)
    handler.addFilter(WithoutToken())
    logging.basicConfig(handlers=[handler], level=settings.log_level, force=True)
    for noisy in ("uvicorn.access", "uvicorn.error", "websockets", "alembic", "numba"):
        logging.getLogger(noisy).setLevel(max(logging.WARNING, logging.getLevelName(settings.log_level)))
