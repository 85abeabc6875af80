"""Settings reference: one table per group of settings."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any, get_args, get_origin

from annotated_types import Ge, Gt, Le, Lt
from pydantic import BaseModel, SecretStr
from pydantic.fields import FieldInfo

from cli.reference.markdown import code, table
from cli.reference.paths import shown
from service.core.settings import OTHER_NAMES, PREFIX, Settings, is_group

HEAD = ["Setting", "Environment", "Type", "Default", "Meaning"]


def setting_pages() -> dict[str, str]:
    """Return the generated parts of the page on settings."""
    groups = {"service": table(HEAD, _rows(Settings, PREFIX))}
    for name, field in Settings.model_fields.items():
        kind = field.annotation
        if is_group(kind):
            groups[name] = table(HEAD, _rows(kind, f"{PREFIX}{name.upper()}__"))
    others = ([code(name), meaning] for name, meaning in OTHER_NAMES.items())
    return groups | {"other names": table(["Environment", "Read by: meaning"], others)}


def _rows(model: type[BaseModel], prefix: str) -> Iterator[list[str]]:
    for name, field in model.model_fields.items():
        if is_group(field.annotation):
            continue
        yield [
            code(name),
            code(prefix + name.upper()),
            _type(field),
            code(_default(field.default)),
            field.description or "",
        ]


def _type(field: FieldInfo) -> str:
    bounds = []
    for sign, kind, attribute in (
        ("≥", Ge, "ge"),
        (">", Gt, "gt"),
        ("≤", Le, "le"),
        ("<", Lt, "lt"),
    ):
        bounds += [
            f"{sign} {getattr(each, attribute):,}"
            for each in field.metadata
            if isinstance(each, kind)
        ]
    return ", ".join([_kind(field.annotation), *bounds])


def _kind(annotation: Any) -> str:
    names = {
        int: "integer",
        float: "number",
        bool: "true or false",
        str: "text",
        SecretStr: "text, shown as ***",
        Path: "path",
        type(None): "",
    }
    if annotation in names:
        return names[annotation]
    if get_origin(annotation) is tuple:
        return "JSON list"
    literals = [each for each in get_args(annotation) if isinstance(each, str)]
    if literals:
        return " or ".join(map(code, literals))
    return next(filter(None, map(_kind, get_args(annotation))), str(annotation))


def _default(value: object) -> str:
    if isinstance(value, Path):
        return shown(value)
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, tuple):
        return "[]"
    return "" if value is None else str(value)
