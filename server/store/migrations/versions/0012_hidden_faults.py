"""Answers to hidden faults."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0012"
down_revision = "0011"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "blind_answers",
        sa.Column("id", sa.String(length=32), nullable=False),
        sa.Column("class_id", sa.String(length=32), nullable=True),
        sa.Column("person_id", sa.String(length=32), nullable=False),
        sa.Column("began", sa.DateTime(timezone=True), nullable=False),
        sa.Column("answer", sa.JSON(), nullable=False),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_blind_answers")),
    )
    with op.batch_alter_table("blind_answers", schema=None) as batch_op:
        batch_op.create_index(batch_op.f("ix_blind_answers_class_id"), ["class_id"], unique=False)


def downgrade() -> None:
    op.drop_table("blind_answers")
