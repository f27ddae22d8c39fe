"""Presentations and layouts of classes, their sheet, and the benches that students were lent."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0017"
down_revision = "0016"
branch_labels = None
depends_on = None


def upgrade() -> None:
    with op.batch_alter_table("classes", schema=None) as batch_op:
        batch_op.add_column(sa.Column("shown", sa.String(length=32), nullable=True))
        batch_op.add_column(sa.Column("layout", sa.JSON(), nullable=True))
        batch_op.add_column(sa.Column("sheet", sa.String(length=40), nullable=True))
    with op.batch_alter_table("people", schema=None) as batch_op:
        batch_op.add_column(sa.Column("lent", sa.String(length=32), nullable=True))


def downgrade() -> None:
    with op.batch_alter_table("people", schema=None) as batch_op:
        batch_op.drop_column("lent")
    with op.batch_alter_table("classes", schema=None) as batch_op:
        batch_op.drop_column("sheet")
        batch_op.drop_column("layout")
        batch_op.drop_column("shown")
