"""The sentences of the narrator about a live bench."""

from __future__ import annotations

from typing import Annotated

from fastapi import Query
from pydantic import BaseModel, Field

from scenarios.narrator.sentence import Sentence
from server.api.deps import SeenDep
from server.api.router import Router
from server.bench.narration import NarrationPlace

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
    after: Annotated[int, Query(ge=0, le=2**53)] = 0,
    jumps: Annotated[int | None, Query(ge=0, le=2**53, description="Number of jumps in the last answer")] = None,
) -> NarrationList:
    """List the sentences of the narrator after a sentence; all sentences if the bench has jumped since."""
    known = NarrationPlace(session.narration.mark.jumps if jumps is None else jumps, after)
    mark, first, sentences = session.narration.after(known)
    return NarrationList(sentences=sentences, after=first, last=mark.last, jumps=mark.jumps)
