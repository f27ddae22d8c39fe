"""Log lines: readable in a terminal, JSON in a container."""

from __future__ import annotations

import json
import logging
import re
import sys
import threading
from datetime import UTC, datetime
from types import TracebackType
from typing import Any

from server.settings import Settings

log = logging.getLogger(__name__)

STANDARD = frozenset(vars(logging.makeLogRecord({})))

SECRET = re.compile(r"(\b(?:token|code)=|/join/)[^&?\s\"']+|(://[^/\s:@]*:)[^/\s\"']+(?=@)")
"""The token of the address to open, the code of a class in the address to join; the password of a database in its."""


class JsonFormatter(logging.Formatter):
    """One JSON object per line."""

    def format(self, record: logging.LogRecord) -> str:
        """Format a record with its extra fields."""
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


class Handler(logging.StreamHandler[Any]):
    """Writes lines with no secret in them."""

    def format(self, record: logging.LogRecord) -> str:
        """Format a record with tokens and passwords left out."""
        return SECRET.sub(r"\1\2...", super().format(record))


class Brief(logging.Filter):
    """Turns errors the web server logs about ill-behaved clients into warnings of one line."""

    def filter(self, record: logging.LogRecord) -> bool:
        """Put the reason into the line."""
        error = record.exc_info[1] if record.exc_info else None
        if record.name == "uvicorn.error" and isinstance(error, UnicodeError | OSError):
            record.msg, record.args, record.exc_info = f"{record.getMessage().rstrip('.')}: {error}", (), None
            record.levelno, record.levelname = logging.WARNING, "WARNING"
        return True


def log_uncaught(kind: type[BaseException], error: BaseException | None, trace: TracebackType | None) -> None:
    """Log an uncaught error, which Python would print."""
    log.critical("unexpected error", exc_info=(kind, error or kind(), trace))


def configure(settings: Settings) -> None:
    """Send all log lines of the process to standard error."""
    as_json = settings.log_format == "json" or (settings.log_format == "auto" and not sys.stderr.isatty())
    handler = Handler(sys.stderr)
    text = logging.Formatter("%(asctime)s %(levelname)-7s %(name)s  %(message)s", "%H:%M:%S")
    handler.setFormatter(JsonFormatter() if as_json else text)
    handler.addFilter(Brief())
    logging.basicConfig(handlers=[handler], level=settings.log_level, force=True)
    for noisy in ("uvicorn.access", "uvicorn.error", "websockets", "alembic"):
        logging.getLogger(noisy).setLevel(max(logging.WARNING, logging.getLevelName(settings.log_level)))
    # Python's own warnings and uncaught errors go the same way.
    logging.captureWarnings(True)
    sys.excepthook = log_uncaught
    threading.excepthook = lambda failure: log_uncaught(failure.exc_type, failure.exc_value, failure.exc_traceback)
    sys.unraisablehook = lambda failure: log_uncaught(failure.exc_type, failure.exc_value, failure.exc_traceback)
