"""Runs migrations on the connection it is given, or on the configured address."""

from __future__ import annotations

from alembic import context
from sqlalchemy import Connection

from server.store import models, people  # noqa: F401  (each adds its tables)
from server.store.base import Base
from server.store.database import make_engine


def migrate(connection: Connection) -> None:
    """Run the migrations; batch mode, because SQLite cannot alter most things in place."""
    context.configure(connection=connection, target_metadata=Base.metadata, render_as_batch=True, compare_type=True)
    with context.begin_transaction():
        context.run_migrations()


given = context.config.attributes.get("connection")
if given is not None:
    migrate(given)
else:
    engine = make_engine(context.config.get_main_option("sqlalchemy.url") or "")
    with engine.connect() as opened:
        migrate(opened)
    engine.dispose()
