"""The page of a list that a request asks for, and the next page in the header ``Link`` of the answer."""

from __future__ import annotations

from datetime import datetime
from types import GenericAlias
from typing import Annotated, Any
from urllib.parse import urlencode

from fastapi import Depends, Query, Request, Response
from pydantic import Field, TypeAdapter, ValidationError

from server.errors import ApiError
from server.paging import ListPage
from server.security.public import PublicOrigin

MOST = 10_000
"""The largest limit, and the rows of a page without a limit unless a list has fewer."""
LINK = {
    "description": 'Address of the next page, as `<address>; rel="next"`; absent on the last page',
    "schema": {"type": "string"},
}


def pages(*kinds: Any, usual: int = MOST, most: int = MOST) -> Any:
    """Return the dependency that reads the page of a list from a request.

    Parameters
    ----------
    kinds : type
        Types of the values in a key of its rows.
    usual, most : int
        Rows of a page without a limit, and the largest limit.
    """
    keys: TypeAdapter[Any] = TypeAdapter(GenericAlias(tuple, kinds))  # type: ignore[arg-type]
    rows = Query(usual, ge=1, le=most, description=f"Most rows of this page: {usual} unless given, at most {most}")
    place = Query(
        None,
        max_length=500,
        description="Cursor of the page, from the header Link of the page before; left out: the first page",
    )

    def page(request: Request, response: Response, limit: int = rows, after: str | None = place) -> ListPage:
        key = None
        if after is not None:
            try:
                key = keys.validate_json(f"[{after}]")
            except ValidationError:
                hint = "use the address in the header Link of the page before"
                raise ApiError(422, "invalid", f"{after[:40]!r} is no cursor of this list", "after", hint) from None

        def tell(query: dict[str, Any]) -> None:
            response.headers["Link"] = f'<{_address(request, query)}>; rel="next"'

        return ListPage(limit, key, tell)

    return Depends(page)


Number = Annotated[int, Field(ge=0, le=2**53)]
AgePage = Annotated[ListPage, pages(datetime, str)]
"""A page of rows in the order of their creation."""
RequestPage = Annotated[ListPage, pages(datetime, str, usual=200)]
"""A page of runs or campaigns, newest first."""


def _address(request: Request, query: dict[str, Any]) -> str:
    """Return the address of the same list with other values in the query, as the caller reaches this server."""
    public: PublicOrigin = request.app.state.service.public
    url = request.url
    base = str(public) if public.origin and url.hostname == public.host else f"{url.scheme}://{url.netloc}"
    same = [(name, value) for name, value in request.query_params.multi_items() if name not in {*query, "offset"}]
    return f"{base}{url.path}?{urlencode([*same, *query.items()])}"
