"""Answers at games."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0018"
down_revision = "0017"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "game_attempts",
        sa.Column("id", sa.String(length=32), nullable=False),
        sa.Column("class_id", sa.String(length=32), nullable=True),
        sa.Column("person_id", sa.String(length=32), nullable=False),
        sa.Column("name", sa.String(length=100), nullable=False),
        sa.Column("game", sa.String(length=40), nullable=False),
        sa.Column("seed", sa.BigInteger(), nullable=False),
        sa.Column("points", sa.Float(), nullable=True),
        sa.Column("at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("attempt", sa.JSON(), nullable=False),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_game_attempts")),
    )
    with op.batch_alter_table("game_attempts", schema=None) as batch_op:
        batch_op.create_index(batch_op.f("ix_game_attempts_class_id"), ["class_id"], unique=False)
        batch_op.create_index(batch_op.f("ix_game_attempts_person_id"), ["person_id"], unique=False)


def downgrade() -> None:
    op.drop_table("game_attempts")
