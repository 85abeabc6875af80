"""The command line: one section a command, from its help texts."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import typer

from cli.reference.markdown import code, paragraphs, table
from cli.reference.paths import shown


def command_pages() -> dict[str, str]:
    """Return the generated part of the page on commands."""
    from cli import app

    root: Any = typer.main.get_command(app)
    sections = list(_sections(root, "placecell"))
    contents = table(
        ["Command", "Does"],
        ([f"[`{name}`](#{_anchor(name)})", _first(each.help)] for name, each in sections),
    )
    return {"commands": contents + "".join(f"\n{_section(*each)}" for each in sections)}


def _sections(group: Any, name: str) -> Iterator[tuple[str, Any]]:
    for word, command in group.commands.items():
        if command.hidden:
            continue
        if hasattr(command, "commands"):
            yield from _sections(command, f"{name} {word}")
        else:
            yield f"{name} {word}", command


def _section(name: str, command: Any) -> str:
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
            [", ".join(map(code, (*each.opts, *each.secondary_opts))), _value(each), _help(each)]
            for each in members
        )
        parts.append("\n" + table([panel, "Value", "Meaning"], rows))
    return "".join(parts)


def _usage(argument: Any) -> str:
    name = _metavar(argument) + ("..." if argument.nargs != 1 else "")
    return name if argument.required else f"[{name}]"


def _metavar(parameter: Any) -> str:
    return str(parameter.metavar or parameter.name.upper())


def _value(option: Any) -> str:
    if option.is_flag:
        return ""
    kind = option.metavar or str(option.display_type).strip("<>")
    repeat = ", repeatable" if option.multiple or "list[" in kind else ""
    return code(kind.replace("list[", "").replace("]", "") if repeat else kind) + repeat


def _help(parameter: Any) -> str:
    text = (parameter.help or "").rstrip()
    more = []
    default = parameter.default
    if parameter.required:
        more.append("Required.")
    elif default not in (None, False, ()) and "default" not in text.lower():
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
