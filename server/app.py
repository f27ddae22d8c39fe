"""The application: routes, gate, one error shape, one service."""

from __future__ import annotations

import contextlib
import importlib.util
from collections.abc import AsyncIterator

from fastapi import FastAPI

from scenarios import wall
from scenarios.extras import require
from server import errors
from server.api import (
    audit,
    bench_files,
    benches,
    benchmarks,
    blind,
    captures,
    catalog,
    claims,
    classes,
    devices,
    diagnosers,
    document,
    documents,
    driving,
    experiments,
    gallery,
    games,
    health,
    instruments,
    joining,
    lectures,
    lesson,
    links,
    me,
    measured_devices,
    narration,
    parameter_sets,
    places,
    progress,
    qr,
    readouts,
    recordings,
    records,
    runs,
    scenarios,
    schemas,
    sheets,
    snapshots,
    stream,
    sweeps,
    testing,
    theory,
    thresholds,
    trace,
    units,
    votes,
    watchers,
)
from server.api.gate import Gate
from server.api.page import Page
from server.api.router import API
from server.security.body import BodyLimit
from server.security.frames import Frames
from server.security.headers import SecurityHeaders
from server.security.heads import Heads
from server.security.identity import Identity, token_of
from server.security.origin import OriginPolicy
from server.service import Service
from server.settings import Settings
from server.version import VERSION

ROUTERS = (
    catalog,
    devices,
    scenarios,
    bench_files,
    schemas,
    units,
    benches,
    instruments,
    narration,
    experiments,
    diagnosers,
    readouts,
    claims,
    snapshots,
    parameter_sets,
    recordings,
    records,
    measured_devices,
    trace,
    runs,
    sweeps,
    thresholds,
    progress,
    gallery,
    benchmarks,
    theory,
    links,
    lectures,
    me,
    classes,
    lesson,
    driving,
    qr,
    blind,
    captures,
    games,
    votes,
    watchers,
    sheets,
    audit,
    stream,
)


def create_app(settings: Settings) -> FastAPI:
    """Build the application; the service starts with its lifespan.

    Parameters
    ----------
    settings : Settings
        Limits and places of the service.

    Raises
    ------
    InputError
        When everyone may bring units and the wall around them cannot be built.
    """
    if settings.units == "everyone":
        wall.build()
    service = Service(settings)
    public = service.public
    token = settings.token.get_secret_value() if settings.token else token_of(settings.data)
    identity = Identity(token, public, loopback_only=settings.classroom)

    frames: Frames | None = None

    @contextlib.asynccontextmanager
    async def lifespan(_app: FastAPI) -> AsyncIterator[None]:
        async with service.running():
            yield
            if frames is not None:
                await app.state.lti.close()

    app = FastAPI(
        title="CombBench",
        version=VERSION,
        description="A live bench for MEMS lateral comb resonators.",
        license_info={"name": "MIT", "identifier": "MIT"},
        lifespan=lifespan,
        openapi_url=f"{API}/openapi.json",
        docs_url=None,
        redoc_url=None,
        redirect_slashes=False,
        servers=[{"url": str(public)}] if public.origin else None,
    )
    app.state.service, app.state.identity = service, identity
    errors.install(app)
    document.install(app)
    for module in (*ROUTERS, health, joining, documents, places):
        app.router.routes += module.router.routes
    if importlib.util.find_spec("server.view3d") is not None:
        from server.api import view3d

        app.router.routes += view3d.router.routes
    if settings.clock == "manual":
        app.router.routes += testing.router.routes
    if settings.lti:
        require("jwt", "lti", "lti")
        from server.api import lti

        frames = lti.install(app, service)
    app.router.default = app.state.page = Page(prefix=public.prefix)
    # A request passes the middleware that was added last first.
    app.add_middleware(Heads)
    uploads = dict.fromkeys(
        records.UPLOADS, (max(settings.max_record_mb, settings.student_record_mb) << 20, "max_record_mb")
    )
    app.add_middleware(BodyLimit, limit=settings.body_limit_bytes, uploads=uploads)
    app.add_middleware(
        Gate,
        identity=identity,
        origin=OriginPolicy(settings.host, settings.allowed_hosts, public, settings.classroom),
        service=service,
        frames=frames,
    )
    app.add_middleware(errors.CatchAll)
    app.add_middleware(SecurityHeaders, prefix=public.prefix, frames=frames)
    return app
