"""Runs and campaigns in one table of requests."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0007"
down_revision = "0006"
branch_labels = None
depends_on = None

SAME = "id, state, title, label, document, created, finished, error"
INDEXED = {
    "requests": ("created", "kind", "state"),
    "runs": ("created", "key", "state"),
    "sweeps": ("created", "state"),
}


def upgrade() -> None:
    _make(
        "requests",
        sa.Column("kind", sa.String(length=16), nullable=False),
        sa.Column("key", sa.String(length=64), server_default="", nullable=False),
        sa.Column("name", sa.String(length=200), nullable=False),
        sa.Column("scenario_id", sa.String(length=200), nullable=False),
        sa.Column("title", sa.String(length=400), nullable=False),
        sa.Column("seeds", sa.JSON(), nullable=True),
        sa.Column("version", sa.String(length=16), server_default="", nullable=False),
        sa.Column("runs", sa.Integer(), nullable=False),
        sa.Column("done", sa.Integer(), server_default="0", nullable=False),
        sa.Column("attempts", sa.Integer(), server_default="0", nullable=False),
        sa.Column("summary", sa.JSON(), nullable=True),
    )
    count = "json_array_length(seeds)"
    op.execute(
        f"INSERT INTO requests ({SAME}, kind, key, name, scenario_id, seeds, runs, done, attempts, summary) "
        f"SELECT {SAME}, 'run', key, scenario_id, scenario_id, seeds, {count}, "
        f"CASE state WHEN 'done' THEN {count} ELSE 0 END, attempts, summary FROM runs"
    )
    op.execute(
        f"INSERT INTO requests ({SAME}, kind, name, scenario_id, version, runs, done) "
        f"SELECT {SAME}, 'campaign', name, '', version, runs, done FROM sweeps"
    )
    requests = sa.table("requests", *(sa.column(name) for name in ("id", "kind", "scenario_id")), _document())
    campaigns = sa.select(requests.c.id, requests.c.document).where(requests.c.kind == "campaign")
    for row_id, document in op.get_bind().execute(campaigns).all():
        scenario = document.get("scenario", "")
        name = scenario if isinstance(scenario, str) else str(scenario.get("id", ""))
        op.execute(requests.update().where(requests.c.id == row_id).values(scenario_id=name[:200]))
    op.drop_table("runs")
    op.drop_table("sweeps")


def downgrade() -> None:
    _make(
        "runs",
        sa.Column("key", sa.String(length=64), nullable=False),
        sa.Column("scenario_id", sa.String(length=200), nullable=False),
        sa.Column("title", sa.String(length=400), nullable=False),
        sa.Column("seeds", sa.JSON(), nullable=False),
        sa.Column("progress", sa.Float(), nullable=False),
        sa.Column("attempts", sa.Integer(), server_default="0", nullable=False),
        sa.Column("summary", sa.JSON(), nullable=True),
    )
    _make(
        "sweeps",
        sa.Column("name", sa.String(length=64), nullable=False),
        sa.Column("title", sa.String(length=200), nullable=False),
        sa.Column("version", sa.String(length=16), nullable=False),
        sa.Column("runs", sa.Integer(), nullable=False),
        sa.Column("done", sa.Integer(), server_default="0", nullable=False),
    )
    op.execute(
        f"INSERT INTO runs ({SAME}, key, scenario_id, seeds, progress, attempts, summary) "
        f"SELECT {SAME}, key, scenario_id, seeds, CASE state WHEN 'done' THEN 1.0 ELSE 0.0 END, attempts, summary "
        "FROM requests WHERE kind = 'run'"
    )
    op.execute(
        f"INSERT INTO sweeps ({SAME}, name, version, runs, done) "
        f"SELECT {SAME}, name, version, runs, done FROM requests WHERE kind = 'campaign'"
    )
    op.drop_table("requests")


def _make(name: str, *columns: sa.Column[object]) -> None:
    """Make one of the three tables, with the common columns and its own."""
    op.create_table(
        name,
        sa.Column("id", sa.String(length=32), nullable=False),
        sa.Column("state", sa.String(length=16), nullable=False),
        sa.Column("label", sa.String(length=120), server_default="", nullable=False),
        _document(),
        sa.Column("created", sa.DateTime(timezone=True), nullable=False),
        sa.Column("finished", sa.DateTime(timezone=True), nullable=True),
        sa.Column("error", sa.JSON(), nullable=True),
        *columns,
        sa.PrimaryKeyConstraint("id", name=op.f(f"pk_{name}")),
    )
    with op.batch_alter_table(name, schema=None) as batch_op:
        for column in INDEXED[name]:
            batch_op.create_index(batch_op.f(f"ix_{name}_{column}"), [column], unique=False)


def _document() -> sa.Column[object]:
    return sa.Column("document", sa.JSON(), nullable=False)
