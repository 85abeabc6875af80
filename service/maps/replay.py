"""From a map's log to one of its versions."""

import logging
from collections.abc import Iterable

from placecell_client import Delta, decode, decode_delta
from placecell_client.maps.edit import compose

from placecell.core.cancellation import current
from service.maps.cache import MapCache
from service.maps.layers import Layers
from service.maps.store import Head, History, MapStore

logger = logging.getLogger("placecell")


def newest(store: MapStore, head: Head, cache: MapCache) -> tuple[Layers, int]:
    """A map's newest version, from the cache if it holds an earlier one of the same map.

    Returns:
        The map, and the sequence of the version that its base is.

    Raises:
        StoreError: what is stored was damaged.
        MapFileError: it is of another version of Placecell.
    """
    with store.read(head.uid) as history:
        cached = cache.load(history)
        if cached is None:
            return version_of(history, head.sequence), head.oldest
        content, sequence = cached
        return _after(Layers.of(content), history, sequence, head.sequence), sequence


def version_of(history: History, sequence: int) -> Layers:
    """One version of a map; errors as of `newest`."""
    base = Layers.of(decode(history.base()))
    return _after(base, history, history.head.oldest, sequence)


def composed(deltas: Iterable[Delta]) -> Delta | None:
    """One delta that does what all do, each following the one before; None for none."""
    row = list(deltas)
    # Pairs, then pairs of pairs: each segment is handled log n times, not n.
    while len(row) > 1:
        current().check()
        pairs = [compose(*row[at : at + 2]) for at in range(0, len(row) - 1, 2)]
        row = pairs + row[2 * len(pairs) :]
    return row[0] if row else None


def _after(layers: Layers, history: History, since: int, until: int) -> Layers:
    delta = composed(_decoded(blob) for _, blob in history.blobs(since, until))
    return layers if delta is None else layers.after(delta)


def _decoded(blob: bytes) -> Delta:
    current().check()
    return decode_delta(blob)
