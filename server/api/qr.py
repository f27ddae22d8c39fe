"""QR codes, for phones to read an address from the screen."""

from __future__ import annotations

from pydantic import BaseModel, Field

from server.api.bodies import Body
from server.api.router import Router

router = Router(tags=["pages"])

PX = 8
"""Pixels of a module."""


class QrText(Body):
    """An address."""

    text: str = Field(pattern="^[!-~]+$", max_length=1000)


class QrCode(BaseModel):
    """The code of an address."""

    image: str = Field(description="PNG as a data URL: dark on white, with its margin, 8 pixels for each module")


@router.post("/qr")
def draw_qr_code(body: QrText) -> QrCode:
    """Draw the QR code of an address."""
    import segno  # few pages show a code

    return QrCode(image=segno.make_qr(body.text, error="m").png_data_uri(scale=PX, border=4))
