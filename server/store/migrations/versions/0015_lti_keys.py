"""Which class, or which student, a launch of a learning platform means: by keyed hashes of its ids."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0015"
down_revision = "0014"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "lti_keys",
        sa.Column("key", sa.String(length=64), nullable=False),
        sa.Column("class_id", sa.String(length=32), nullable=False),
        sa.Column("person_id", sa.String(length=32), nullable=True),
        sa.PrimaryKeyConstraint("key", name=op.f("pk_lti_keys")),
    )
    with op.batch_alter_table("lti_keys", schema=None) as batch_op:
        batch_op.create_index(batch_op.f("ix_lti_keys_class_id"), ["class_id"], unique=False)


def downgrade() -> None:
    op.drop_table("lti_keys")
