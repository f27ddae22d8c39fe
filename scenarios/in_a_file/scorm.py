"""A package of SCORM 1.2: a page and its manifest, in one archive that a course takes in."""

from __future__ import annotations

import io
import zipfile
from xml.sax.saxutils import escape

PAGE = "index.html"
MOMENT = (1980, 1, 1, 0, 0, 0)
"""Of every entry, so that the same page gives the same bytes."""
MANIFEST = """<?xml version="1.0" encoding="UTF-8"?>
<manifest identifier="combbench-{name}" version="1.2" xmlns="http://www.imsproject.org/xsd/imscp_rootv1p1p2"
  xmlns:adlcp="http://www.adlnet.org/xsd/adlcp_rootv1p2">
  <metadata>
    <schema>ADL SCORM</schema>
    <schemaversion>1.2</schemaversion>
  </metadata>
  <organizations default="bench">
    <organization identifier="bench">
      <title>{title}</title>
      <item identifier="item" identifierref="page">
        <title>{title}</title>
      </item>
    </organization>
  </organizations>
  <resources>
    <resource identifier="page" type="webcontent" adlcp:scormtype="sco" href="{page}">
      <file href="{page}"/>
    </resource>
  </resources>
</manifest>
"""


def package(name: str, title: str, page: str) -> bytes:
    """Return the archive of a page."""
    manifest = MANIFEST.format(name=escape(name), title=escape(title), page=PAGE)
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for entry, text in (("imsmanifest.xml", manifest), (PAGE, page)):
            archive.writestr(zipfile.ZipInfo(entry, MOMENT), text, zipfile.ZIP_DEFLATED)
    return content.getvalue()
