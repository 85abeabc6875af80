"""`/livez`, `/readyz`, `/metrics`, `/info`: state and facts of the service."""

from dataclasses import asdict

import anyio.to_thread
from fastapi import APIRouter, Depends, Request, Response
from fastapi.responses import PlainTextResponse
from placecell_client.maps.map_file import FORMAT, MEDIA_TYPE, VERSION
from prometheus_client import CONTENT_TYPE_LATEST, generate_latest

from placecell.localization import Confidence
from service.api.body.problem_json import documented
from service.api.dependencies import PrincipalOf, StateOf, principal_of
from service.api.known_query import known_query
from service.api.schemas.info import (
    AcceptanceOut,
    CostsOut,
    HealthResponse,
    InfoResponse,
    KeyResponse,
    MapFileOut,
    ModelOut,
)
from service.core.cost import MACHINE, RATES
from service.core.problems import Problem
from service.inference.model_registry import Model

router = APIRouter(tags=["health"])

BAD_KEYS = (
    "The key file is missing or cannot be read; see the log for the reason. Until you repair it, "
    "no new key works, and keys that it no longer holds are refused after a minute."
)


@router.get("/livez", summary="Check that the process runs", response_model_exclude_none=True)
async def livez() -> HealthResponse:
    """Liveness: the process answers. Restart the service if it does not."""
    return HealthResponse(status="alive")


@router.get(
    "/readyz",
    summary="Check that the service is ready",
    responses=documented(503),
    response_model_exclude_none=True,
)
async def readyz(state: StateOf) -> HealthResponse:
    """Readiness: models and maps are loaded and can be served; send no requests if not.

    Without a database, a service that cannot store maps is not ready either. With a database, a
    service is ready as long as its maps are level with the database. It stays ready while the
    database cannot be reached, because no other service could store maps then.

    `warnings` lists problems that need an operator although the service still works, such as an
    unreadable key file.
    """
    if state.draining:
        raise Problem(
            503, "not-ready", "The service is stopping. Send requests to another instance."
        )
    # In its own thread: a disk may hang, and no other request waits for it.
    trouble = await anyio.to_thread.run_sync(state.engine.unready)
    if trouble is not None:
        raise Problem(503, "not-ready", trouble)
    warnings = state.engine.warnings()
    if not state.keys.is_good():
        if not state.keys.any_works():
            raise Problem(503, "not-ready", f"{BAD_KEYS} No key works now.")
        warnings = [BAD_KEYS, *warnings]
    return HealthResponse(status="ready", warnings=warnings or None)


@router.get("/metrics", summary="Read metrics for Prometheus", response_class=PlainTextResponse)
async def metrics(state: StateOf) -> Response:
    """Return counters and times in the text format of Prometheus."""
    return Response(generate_latest(state.metrics.registry), media_type=CONTENT_TYPE_LATEST)


@router.get(
    "/info",
    summary="Read version, models and limits",
    responses=documented(401, 422),
    dependencies=[Depends(known_query)],
)
async def info(request: Request, state: StateOf, principal: PrincipalOf) -> InfoResponse:
    """Return the facts that a client needs before its first request."""
    del principal  # any key may read them
    models = [_model_out(model) for model in state.engine.models.all()]
    return InfoResponse(
        version=request.app.version,
        model=models[0],
        models=models,
        limits=state.settings.limits,
        costs=CostsOut(machine=MACHINE, **asdict(RATES)),
        map_file=MapFileOut(format=FORMAT, version=VERSION, media_type=MEDIA_TYPE),
    )


@router.get(
    "/key",
    summary="Read the scope of the key",
    responses=documented(422),
    dependencies=[Depends(known_query)],
)
async def key(request: Request, state: StateOf) -> KeyResponse:
    """Return what the key of this request may do, so that a program offers no more.

    A request without a known key is answered too: its role is `none`.
    """
    try:
        principal = await principal_of(request)
    except Problem:
        return KeyResponse(name="", role="none", may_write=False, maps=[], robot=None, open=False)
    scope = principal.key
    return KeyResponse(
        name=principal.name,
        role="admin" if scope.admin else "write" if scope.write else "read",
        may_write=scope.write,
        maps=list(scope.maps),
        robot=scope.robot,
        open=not state.keys,
    )


def _model_out(model: Model) -> ModelOut:
    manifest = model.manifest
    return ModelOut(
        model_id=manifest.model_id,
        name=manifest.name,
        method=manifest.method,
        network=manifest.network,
        dimension=manifest.dimension,
        code_bytes=manifest.code_bytes,
        per_byte=manifest.quantizer.per_byte,
        surroundings=manifest.neighborhood is not None,
        step=manifest.quantizer.step,
        pair_threshold=manifest.pair_threshold,
        preprocessing=manifest.preprocessing,
        acceptance=_acceptance_out(model.confidence),
    )


def _acceptance_out(confidence: Confidence) -> AcceptanceOut | None:
    if confidence.acceptance is None:
        return None
    threshold, risk = confidence.threshold(None, 0.0)
    assert risk is not None  # the model has a calibration
    return AcceptanceOut(
        max_false_acceptance=risk,
        smallest=confidence.acceptance.smallest_risk,
        threshold=threshold,
        queries=confidence.acceptance.queries,
    )
