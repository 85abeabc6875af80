"""`/models/reload`: load models that changed on disk."""

from fastapi import APIRouter, Request

from placecell.descriptors.manifest import ModelError
from service.api.audit import logger
from service.api.body.problem_json import documented
from service.api.dependencies import PrincipalOf, StateOf
from service.api.schemas.info import ReloadResponse
from service.core.problems import Problem

router = APIRouter(tags=["models"])


@router.post("/models/reload", summary="Reload the models", responses=documented(401, 403, 409))
async def reload(request: Request, state: StateOf, principal: PrincipalOf) -> ReloadResponse:
    """Load the models whose folders were replaced; for administrators.

    Requests in progress finish with their old model. A model that cannot be loaded is refused with
    a 409, and the old one stays in use. Models that made stored maps stay loaded.
    """
    principal.check_admin()
    try:
        models = await state.run(state.engine.reload_models)
    except ModelError as error:
        raise Problem(
            409, "broken-model", f"The model cannot be loaded; the old one stays in use. {error}."
        ) from error
    ids = [model.id for model in models]
    facts = {"key": principal.name, "request_id": request.scope["state"]["request_id"]}
    logger.info("%s reload models, now %s", principal.name, ", ".join(ids), extra=facts)
    return ReloadResponse(model_id=ids[0], models=ids)
