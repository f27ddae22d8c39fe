"""The secret of a class, from which the numbers of each student are drawn."""

from __future__ import annotations

import secrets

import sqlalchemy as sa
from alembic import op

revision = "0010"
down_revision = "0009"
branch_labels = None
depends_on = None


def upgrade() -> None:
    with op.batch_alter_table("classes", schema=None) as batch_op:
        batch_op.add_column(sa.Column("secret", sa.String(length=64), server_default="", nullable=False))
    classes = sa.table("classes", sa.column("id", sa.String), sa.column("secret", sa.String))
    connection = op.get_bind()
    for id_ in connection.execute(sa.select(classes.c.id)).scalars().all():
        connection.execute(classes.update().where(classes.c.id == id_).values(secret=secrets.token_urlsafe(32)))


def downgrade() -> None:
    with op.batch_alter_table("classes", schema=None) as batch_op:
        batch_op.drop_column("secret")
