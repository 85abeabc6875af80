"""Validation of uploaded map and delta files against the loaded models."""

from placecell_client import CompactMap, Delta, MapFileError, decode, decode_delta

from service.core.problems import Problem
from service.inference.model_registry import Models


def read_map_file(data: bytes, models: Models) -> CompactMap:
    """Decode an uploaded map file.

    Raises:
        Problem: 422 if the bytes are not a valid map file, 409 if its model is not loaded.
    """
    try:
        content = decode(data)
    except MapFileError as error:
        raise Problem(
            422,
            "invalid-map-file",
            f"The body is not a complete map file: {error}. Encode the map again and resend it.",
        ) from error
    _check_model(content, models, "invalid-map-file")
    return content


def read_delta_file(data: bytes, models: Models) -> Delta:
    """Decode an uploaded delta file that applies to any version.

    Raises:
        Problem: 422 if the bytes are not a valid delta file, 409 if its model is not loaded.
    """
    try:
        delta = decode_delta(data)
    except MapFileError as error:
        raise Problem(
            422,
            "invalid-delta-file",
            f"The body is not a complete delta file: {error}. "
            "Encode the delta again and resend it.",
        ) from error
    if delta.since or delta.until:
        raise Problem(
            422,
            "invalid-delta-file",
            f"The delta leads from version {delta.since} to version {delta.until}; in an edit, "
            "both must be 0. Name the version that the edit is for with If-Match.",
        )
    _check_model(delta.changed, models, "invalid-delta-file")
    return delta


def check_joins(content: CompactMap, name: str, other: CompactMap) -> None:
    """Check that segments can be added to a map.

    Args:
        content: the segments.
        name: name of the map.
        other: segments of the map.

    Raises:
        Problem: 409 if they have another model or frame than the map.
    """
    for attribute, kind in (("model_id", "other-model"), ("frame", "other-frame")):
        given, expected = getattr(content, attribute), getattr(other, attribute)
        if given != expected:
            raise Problem(
                409,
                kind,
                f"The segments have {attribute} {given!r:.100}; map {name!r} has {expected!r:.100}."
                " Write them to another map.",
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
            f"The codes have {content.code_bytes} bytes per segment; model {manifest.model_id!r} "
            f"has {manifest.code_bytes}.",
        )
    if content.preprocessing != manifest.preprocessing["version"]:
        raise Problem(
            422,
            kind,
            f"The segments have preprocessing version {content.preprocessing}; model "
            f"{manifest.model_id!r} has version {manifest.preprocessing['version']}.",
        )
