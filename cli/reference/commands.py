"""Command-line reference: one section per command, made from the help texts."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import typer

from cli.reference.markdown import code, paragraphs, table
from cli.reference.paths import shown

TYPES = {
    "int": "integer",
    "int range": "integer",
    "float": "number",
    "float range": "number",
    "str": "text",
    "datetime": "date or time",
}
"""Names of types as the page shows them; others stay as they are."""


def command_pages() -> dict[str, str]:
    """Return the generated part of the page on commands."""
    from cli import app

    root: Any = typer.main.get_command(app)
    sections = list(_sections(root, "placecell"))
    contents = table(
        ["Command", "Does"],
        ([f"[`{name}`](#{_anchor(name)})", _first(each.help)] for name, each in sections),
    )
    context = root.make_context("placecell", ["--help"], resilient_parsing=True)
    return {"commands": contents + "".join(f"\n{_section(*each, context)}" for each in sections)}


def _sections(group: Any, name: str) -> Iterator[tuple[str, Any]]:
    for word, command in group.commands.items():
        if command.hidden:
            continue
        if hasattr(command, "commands"):
            yield from _sections(command, f"{name} {word}")
        else:
            yield f"{name} {word}", command


def _section(name: str, command: Any, context: Any) -> str:
    parts = [f"## `{name}`\n\n", paragraphs(command.help or "")]
    arguments = [each for each in command.params if each.param_type_name == "argument"]
    options = [each for each in command.params if each.param_type_name == "option"]
    usage = [name, "[OPTIONS]" if options else "", *(_usage(each) for each in arguments)]
    parts.append(f"\n```text\n{' '.join(filter(None, usage))}\n```\n")
    if arguments:
        rows = ([code(_metavar(each)), _help(each)] for each in arguments)
        parts.append("\n" + table(["Argument", "Meaning"], rows))
    panels: dict[str, list[Any]] = {}
    for option in options:
        if not option.hidden:
            panels.setdefault(option.rich_help_panel or "Option", []).append(option)
    for panel, members in panels.items():
        rows = (
            [
                ", ".join(map(code, (*each.opts, *each.secondary_opts))),
                _value(each, context),
                _help(each),
            ]
            for each in members
        )
        parts.append("\n" + table([panel, "Value", "Meaning"], rows))
    return "".join(parts)


def _usage(argument: Any) -> str:
    name = _metavar(argument) + ("..." if argument.nargs != 1 else "")
    return name if argument.required else f"[{name}]"


def _metavar(parameter: Any) -> str:
    return str(parameter.metavar or parameter.name.upper())


def _value(option: Any, context: Any) -> str:
    if option.is_flag:
        return ""
    kind = str(option.metavar or option.display_type(context).strip("<>"))
    element = re.fullmatch(r"list\[(.+)\]", kind)
    shown = TYPES.get(element[1] if element else kind, element[1] if element else kind)
    repeated = ", repeatable" if option.multiple or element else ""
    return code(shown + _bounds(option)) + repeated


def _bounds(option: Any) -> str:
    """Return the range of a number, such as ` 0 to 1`."""
    if option.min is None and option.max is None:
        return ""
    if option.max is None:
        return f" >= {option.min:g}"
    return f" <= {option.max:g}" if option.min is None else f" {option.min:g} to {option.max:g}"


def _help(parameter: Any) -> str:
    text = (parameter.help or "").rstrip()
    more = []
    default = parameter.default
    if parameter.required:
        more.append("Required.")
    elif default is not None and default is not False and "default" not in text.lower():
        more.append(f"Default: {code(_shown(default))}.")
    if parameter.envvar:
        more.append(f"Environment: {code(parameter.envvar)}.")
    return " ".join([text, *more])


def _shown(value: object) -> str:
    if isinstance(value, bool):
        return "on"
    if isinstance(value, Path):
        return shown(value)
    if isinstance(value, list | tuple):
        return " ".join(map(_shown, value))
    return str(value)


def _first(text: str | None) -> str:
    return " ".join((text or "").strip().split("\n\n")[0].split())


def _anchor(name: str) -> str:
    return name.replace(" ", "-")
