"""Validation of uploaded map and delta files against the loaded models."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Literal

from placecell_client import CompactMap, Delta, MapFileError

from service.core.problems import Problem
from service.inference.model_registry import Model

FileKind = Literal["map", "delta"]


@contextmanager
def reading(kind: FileKind) -> Iterator[None]:
    """Turn an error of an uploaded file's decoding into a problem.

    Raises:
        Problem: 422 if the bytes are not a valid file of this kind.
    """
    try:
        yield
    except MapFileError as error:
        raise Problem(
            422,
            f"invalid-{kind}-file",
            f"The body is not a complete {kind} file: {error}. "
            f"Encode the {kind} again and resend it.",
        ) from error


def check_applies_to_any(delta: Delta) -> None:
    """Check that an edit is a delta for any version; 422 if not."""
    if delta.since or delta.until:
        raise Problem(
            422,
            "invalid-delta-file",
            f"The delta leads from version {delta.since} to version {delta.until}; in an edit, "
            "both must be 0. Name the version that the edit is for with If-Match.",
        )


def check_model(content: CompactMap, model: Model, kind: FileKind) -> None:
    """Check that segments were made as their model makes them; 422 if not."""
    manifest = model.manifest
    if content.code_bytes != manifest.code_bytes:
        raise Problem(
            422,
            f"invalid-{kind}-file",
            f"The codes have {content.code_bytes} bytes per segment; model {manifest.model_id!r} "
            f"has {manifest.code_bytes}.",
        )
    if content.preprocessing != manifest.preprocessing["version"]:
        raise Problem(
            422,
            f"invalid-{kind}-file",
            f"The segments have preprocessing version {content.preprocessing}; model "
            f"{manifest.model_id!r} has version {manifest.preprocessing['version']}.",
        )


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
