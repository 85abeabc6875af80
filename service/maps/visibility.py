"""Visibility: hides names of maps and keys that a key may not know.

A merged map keeps of each segment the name of the map that it came from. A key that does not open
that map sees a pseudonym in its place: always the same one within a map, so that copies and changes
fit each other, and turned back into the name when the key writes what it read.
"""

import hashlib
from collections import Counter
from dataclasses import replace

from placecell_client import CompactMap, Delta
from placecell_client.maps.canonical import canonical

from service.core.auth import Holder
from service.core.problems import Problem
from service.maps.layers import MapLayers
from service.maps.snapshot import MapSnapshot

HIDDEN_AUTHOR = "another key"
"""Text that replaces another key's name."""

PSEUDONYM = "hidden:"
"""Prefix of a pseudonym; no map can have such a name."""


def author_for(holder: Holder, author: str) -> str:
    """Return a version's author as a key may see it: its own name, or any if it opens all maps."""
    return author if holder.opens_all or author == holder.name else HIDDEN_AUTHOR


def sources_for(holder: Holder, sources: Counter[str]) -> dict[str, int]:
    """Return the sources of a map that a key may see, by name."""
    return {name: count for name, count in sorted(sources.items()) if holder.opens(name)}


def is_hidden_from(holder: Holder, layers: MapLayers) -> bool:
    """Return whether a map has sources that a key may not see."""
    return not holder.opens_all and not all(map(holder.opens, layers.sources))


def content_for(holder: Holder, uid: str, content: CompactMap) -> CompactMap:
    """Replace names that a key may not see by pseudonyms in a map's segments.

    Args:
        holder: of the key.
        uid: of the map; no client knows it, so nobody can try names until a pseudonym fits.
        content: in canonical form; so is what is returned.
    """
    if holder.opens_all:
        return content
    hidden = {name for name in content.sources if not holder.opens(name)}
    return _renamed(content, {name: _pseudonym(uid, name) for name in hidden})


def delta_for(holder: Holder, uid: str, delta: Delta) -> Delta:
    """Replace names by pseudonyms in a map's delta; see `content_for`."""
    return replace(delta, changed=content_for(holder, uid, delta.changed))


def written_by(holder: Holder, stored: MapSnapshot | None, content: CompactMap) -> CompactMap:
    """Replace pseudonyms by names in what a key writes.

    Args:
        holder: of the key.
        stored: the map as it is; None if there is none yet.
        content: the segments.

    Raises:
        Problem: 403 if segments name a source that the key does not open. Whether a name that was
            tried is one of the map's would show in the pseudonym that comes back.
    """
    if holder.opens_all or not content.sources:
        return content
    for name in content.sources:
        if not name.startswith(PSEUDONYM) and not holder.opens(name):
            raise Problem(
                403,
                "forbidden",
                f"Segments name the source map {name!r:.80}, which this key does not open.",
            )
    if stored is None:
        return content
    layers, uid = stored.layers, stored.head.uid
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
