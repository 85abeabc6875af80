"""`/livez`, `/readyz`, `/info`: for those who run the service, and for clients' limits."""

from fastapi import APIRouter, Request
from placecell_client.map_file import FORMAT, MEDIA_TYPE, VERSION

from service.problems import Problem, documented
from service.schemas import HealthResponse, InfoResponse, MapFileOut, ModelOut
from service.state import StateOf

router = APIRouter(tags=["health"])


@router.get("/livez", summary="The process answers")
async def livez() -> HealthResponse:
    """Restart the service if this fails."""
    return HealthResponse(status="alive")


@router.get("/readyz", summary="The service can work", responses=documented(503))
async def readyz(state: StateOf) -> HealthResponse:
    """The model and the maps are loaded, and maps can be stored; send no requests if this fails."""
    if not state.maps.writable():
        raise Problem(503, "not-ready", "The data directory is gone or cannot be written.")
    return HealthResponse(status="ready")


@router.get("/info", summary="Version, model, limits")
async def info(request: Request, state: StateOf) -> InfoResponse:
    """What a client needs to know before it sends anything."""
    manifest = state.describer.manifest
    return InfoResponse(
        version=request.app.version,
        model=ModelOut(
            model_id=manifest.model_id,
            name=manifest.name,
            method=manifest.method,
            network=manifest.network,
            dimension=manifest.dimension,
            code_bytes=manifest.code_bytes,
            per_byte=manifest.quantiser.per_byte,
            surroundings=manifest.surroundings is not None,
            step=manifest.quantiser.step,
            pair_threshold=manifest.pair_threshold,
            preprocessing=manifest.preprocessing,
        ),
        limits=state.settings.limits,
        map_file=MapFileOut(format=FORMAT, version=VERSION, media_type=MEDIA_TYPE),
    )
