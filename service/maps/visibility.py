"""Visibility: hides names of maps and keys that a key may not know.

A merged map keeps the name of the map that each segment came from. A key without access to that
map sees a pseudonym instead of the name. Within a map the pseudonym is always the same, so that
copies and changes match. When the key writes what it read, the service restores the name.
"""

import hashlib
from collections import Counter
from dataclasses import replace

from placecell_client import CompactMap, Delta
from placecell_client.maps.canonical import canonical

from service.core.auth import Principal
from service.core.problems import Problem
from service.maps.layers import MapLayers
from service.maps.snapshot import MapSnapshot

HIDDEN_AUTHOR = "another key"
"""Text that replaces another key's name."""

PSEUDONYM = "hidden:"
"""Prefix of a pseudonym; no map can have such a name."""


def author_for(principal: Principal, author: str) -> str:
    """Return a version's author, or a text that hides it from a key of other maps."""
    return author if principal.covers_all or author == principal.name else HIDDEN_AUTHOR


def sources_for(principal: Principal, sources: Counter[str]) -> dict[str, int]:
    """Return the sources of a map that a key may see, by name."""
    return {name: count for name, count in sorted(sources.items()) if principal.covers(name)}


def is_hidden_from(principal: Principal, layers: MapLayers) -> bool:
    """Return whether a map has sources that a key may not see."""
    return not principal.covers_all and not all(map(principal.covers, layers.sources))


def hide_names(principal: Principal, uid: str, content: CompactMap) -> CompactMap:
    """Replace names that a key may not see by pseudonyms in a map's segments.

    Args:
        principal: principal of the request.
        uid: uid of the map; no client knows it, so nobody can guess names by their pseudonyms.
        content: segments in canonical form; so is the result.
    """
    if principal.covers_all:
        return content
    hidden = {name for name in content.sources if not principal.covers(name)}
    return _renamed(content, {name: _pseudonym(uid, name) for name in hidden})


def hide_names_in_delta(principal: Principal, uid: str, delta: Delta) -> Delta:
    """Replace names by pseudonyms in a map's delta; see `hide_names`."""
    return replace(delta, changed=hide_names(principal, uid, delta.changed))


def restore_names(
    principal: Principal, snapshot: MapSnapshot | None, content: CompactMap
) -> CompactMap:
    """Replace pseudonyms by names in segments that a key writes.

    Args:
        principal: principal of the request.
        snapshot: the map as it is; None if it is new.
        content: the segments.

    Raises:
        Problem: 403 if segments name a source outside the scope of the key. Otherwise a key could
            write a guessed name and learn from the pseudonym whether the map has it.
    """
    if principal.covers_all or not content.sources:
        return content
    for name in content.sources:
        if not name.startswith(PSEUDONYM) and not principal.covers(name):
            raise Problem(
                403,
                "forbidden",
                f"Segments name the source map {name!r:.80}, which this key has no access to. "
                "Remove the name, or write with a key that has access.",
            )
    if snapshot is None:
        return content
    layers, uid = snapshot.layers, snapshot.head.uid
    names = {*layers.base.sources, *layers.recent.sources}
    known = {_pseudonym(uid, name): name for name in names}
    return _renamed(content, {name: known[name] for name in content.sources if name in known})


def _pseudonym(uid: str, name: str) -> str:
    return PSEUDONYM + hashlib.sha256(f"{uid} {name}".encode()).hexdigest()[:16]


def _renamed(content: CompactMap, names: dict[str, str]) -> CompactMap:
    if not names:
        return content
    return canonical(
        replace(content, sources=tuple(names.get(name, name) for name in content.sources))
    )
