"""The sentences of the narrator about a live bench."""

from __future__ import annotations

from typing import Annotated

from fastapi import Query
from pydantic import BaseModel, Field

from scenarios.narrator.sentence import Sentence
from server.api.deps import SeenDep
from server.api.paging import Number, pages
from server.api.router import Router
from server.bench.narration import KEPT, NarrationPlace
from server.paging import ListPage

router = Router(prefix="/benches", tags=["benches"])


class NarrationList(BaseModel):
    """Sentences of the present run of a bench after a number; a recording has all its sentences at once."""

    sentences: list[Sentence]
    after: int = Field(description="Number before the first sentence: the number of the request, 0 after a jump")
    last: int = Field(description="Number of the last sentence")
    jumps: int = Field(description="Number of resets and returns to the past, which make earlier sentences void")


@router.get("/{bench_id}/narration")
async def list_narration(
    session: SeenDep,
    page: Annotated[ListPage, pages(Number, usual=KEPT)],
    jumps: Annotated[int | None, Query(ge=0, le=2**53, description="Number of jumps in the last answer")] = None,
) -> NarrationList:
    """List the sentences of the narrator; `after` is the number of a sentence, whose followers are listed.

    All sentences are listed if the bench has jumped since.
    """
    known = NarrationPlace(session.narration.mark.jumps if jumps is None else jumps, page.after[0] if page.after else 0)
    mark, first, sentences = session.narration.after(known)
    rows = page.rows(list(enumerate(sentences, first + 1)), lambda row: row[:1], jumps=mark.jumps)
    return NarrationList(sentences=[one for _, one in rows], after=first, last=mark.last, jumps=mark.jumps)
