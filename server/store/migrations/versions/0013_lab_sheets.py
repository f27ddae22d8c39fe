"""Lab sheets of users, and the progress of students with sheets."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0013"
down_revision = "0012"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "sheets",
        sa.Column("id", sa.String(length=40), nullable=False),
        sa.Column("text", sa.Text(), nullable=False),
        sa.Column("created", sa.DateTime(timezone=True), nullable=False),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_sheets")),
    )
    op.create_table(
        "sheet_progress",
        sa.Column("person_id", sa.String(length=32), nullable=False),
        sa.Column("sheet_id", sa.String(length=40), nullable=False),
        sa.Column("class_id", sa.String(length=32), nullable=True),
        sa.Column("bench_id", sa.String(length=32), nullable=False),
        sa.Column("begun", sa.DateTime(timezone=True), nullable=False),
        sa.Column("progress", sa.JSON(), nullable=False),
        sa.PrimaryKeyConstraint("person_id", "sheet_id", name=op.f("pk_sheet_progress")),
    )
    with op.batch_alter_table("sheets", schema=None) as batch_op:
        batch_op.create_index(batch_op.f("ix_sheets_created"), ["created"], unique=False)
    with op.batch_alter_table("sheet_progress", schema=None) as batch_op:
        batch_op.create_index(batch_op.f("ix_sheet_progress_class_id"), ["class_id"], unique=False)


def downgrade() -> None:
    op.drop_table("sheet_progress")
    op.drop_table("sheets")
