"""`/models`: what the service runs."""

from fastapi import APIRouter, Request

from placecell.descriptors.manifest import ModelError
from service.api.audit import logger
from service.api.body.problem_json import documented
from service.api.dependencies import HolderOf, StateOf
from service.api.schemas.info import ReloadResponse
from service.core.problems import Problem

router = APIRouter(tags=["models"])


@router.post("/models/reload", summary="Load the models anew", responses=documented(401, 403, 409))
async def reload(request: Request, state: StateOf, holder: HolderOf) -> ReloadResponse:
    """After a model's folder was replaced. Requests at work end with the model they began with.

    A model that cannot be used is refused with the reason, and the old one goes on. Models that
    stored maps were made with stay loaded.
    """
    holder.check_admin()
    try:
        models = await state.run(state.engine.reload_models)
    except ModelError as error:
        raise Problem(409, "broken-model", f"The old model goes on. {error}.") from error
    ids = [model.id for model in models]
    facts = {"key": holder.name, "request_id": request.scope["state"]["request_id"]}
    logger.info("%s reload models, now %s", holder.name, ", ".join(ids), extra=facts)
    return ReloadResponse(model_id=ids[0], models=ids)
