"""Check of the query: a parameter that the route does not know is refused, not ignored."""

from difflib import get_close_matches
from typing import Any, get_args, get_origin

from fastapi import Request
from fastapi.dependencies.models import Dependant
from fastapi.routing import APIRoute

from service.core.problems import Problem, invalid_values


async def known_query(request: Request) -> None:
    """Check that the route has each parameter of the query, and takes it as often as it is given.

    Raises:
        Problem: 422 with the parameters of the route. An ignored `ignore=` or `keep=` would answer
            with what the client did not ask for.
    """
    query = request.query_params
    if not query:
        return
    route = request.scope["route"]
    assert isinstance(route, APIRoute)
    known = _parameters(route.dependant)
    wrong = {name: _unknown(name, [*known]) for name in query if name not in known}
    for name, takes_list in known.items():
        given = len(query.getlist(name))
        if given > 1 and not takes_list:
            wrong[name] = f"{given} values are given; the parameter takes one"
    if wrong:
        raise _problem(wrong)


def _problem(wrong: dict[str, str]) -> Problem:
    found = [
        {"loc": ("query", name[:80]), "msg": detail, "type": "query"}
        for name, detail in wrong.items()
    ]
    return invalid_values(found)


def _unknown(name: str, known: list[str]) -> str:
    if not known:
        return "the route takes no parameters in the query"
    near = get_close_matches(name, known, 1)
    meant = f". Did you mean {near[0]!r}?" if near else "."
    return f"unknown parameter{meant} The route takes {', '.join(known)}"


def _parameters(dependant: Dependant) -> dict[str, bool]:
    """Return the names of a route's parameters in the query, and whether each takes a list."""
    known = {each.alias: _takes_list(each.field_info.annotation) for each in dependant.query_params}
    for each in dependant.dependencies:
        known |= _parameters(each)
    return known


def _takes_list(annotation: Any) -> bool:
    return get_origin(annotation) is list or any(map(_takes_list, get_args(annotation)))
