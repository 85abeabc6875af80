"""Uploaded files, read and held against the models."""

from placecell_client import CompactMap, Delta, MapFileError, decode, decode_delta

from service.core.problems import Problem
from service.inference.model_registry import Models


def map_of(data: bytes, models: Models) -> CompactMap:
    """The map of a file that was uploaded.

    Raises:
        Problem: 422 if it is none, 409 if its model is not loaded.
    """
    try:
        content = decode(data)
    except MapFileError as error:
        raise Problem(422, "invalid-map-file", f"Not a whole map file: {error}.") from error
    _check_model(content, models, "invalid-map-file")
    return content


def edit_of(data: bytes, models: Models) -> Delta:
    """The delta of a file that was uploaded, for whatever is there.

    Raises:
        Problem: 422 if it is none, 409 if its model is not loaded.
    """
    try:
        delta = decode_delta(data)
    except MapFileError as error:
        raise Problem(422, "invalid-delta-file", f"Not a whole delta file: {error}.") from error
    if delta.since or delta.until:
        raise Problem(
            422,
            "invalid-delta-file",
            f"The delta leads from version {delta.since} to {delta.until}; of an edit both are 0, "
            "and If-Match says which version it is for.",
        )
    _check_model(delta.changed, models, "invalid-delta-file")
    return delta


def check_joins(content: CompactMap, name: str, other: CompactMap) -> None:
    """See that segments may stand in a map.

    Args:
        content: the segments.
        name: of the map.
        other: segments of it.

    Raises:
        Problem: 409 if they are of another model or frame.
    """
    for what, kind in (("model_id", "other-model"), ("frame", "other-frame")):
        given, there = getattr(content, what), getattr(other, what)
        if given != there:
            raise Problem(
                409,
                kind,
                f"The segments' {what} is {given!r:.100}; that of map {name!r} is {there!r:.100}.",
            )


def _check_model(content: CompactMap, models: Models, kind: str) -> None:
    model = models.find(content.model_id)
    if model is None:
        raise models.unknown(content.model_id)
    manifest = model.manifest
    if content.code_bytes != manifest.code_bytes:
        raise Problem(
            422,
            kind,
            f"The codes have {content.code_bytes} bytes a segment; the model's have "
            f"{manifest.code_bytes}.",
        )
    if content.preprocessing != manifest.preprocessing["version"]:
        raise Problem(
            422,
            kind,
            f"The segments were prepared by version {content.preprocessing}; the model's are by "
            f"version {manifest.preprocessing['version']}.",
        )
