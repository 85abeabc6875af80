"""Memory of the loops that the last optimization of each map found."""

from collections import OrderedDict
from threading import Lock

from placecell.pose_graph.known_loops import KnownLoops

MOST = 32
"""Largest number of maps whose loops are remembered; the least recently optimized is forgotten."""


class LoopMemory:
    """Loops by map and model. They are lost at the end of the service, and found again then."""

    def __init__(self, most: int = MOST) -> None:
        self._most = most
        self._known: OrderedDict[tuple[str, str], KnownLoops] = OrderedDict()
        self._lock = Lock()

    def get(self, name: str, model_id: str) -> KnownLoops | None:
        """Return the known loops of a map; None if there are none."""
        with self._lock:
            return self._known.get((name, model_id))

    def put(self, name: str, model_id: str, known: KnownLoops) -> None:
        """Remember the loops of a map in place of earlier ones."""
        with self._lock:
            self._known[name, model_id] = known
            self._known.move_to_end((name, model_id))
            while len(self._known) > self._most:
                self._known.popitem(last=False)
