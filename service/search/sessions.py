"""Sessions: results of each robot's last requests, which support its next one."""

from collections import OrderedDict, defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from threading import Lock
from time import monotonic
from typing import Protocol

from placecell.core.types import Float64
from placecell.localization import Hypothesis, LocalizationParameters
from placecell.localization.evidence import Evidence, RequestHistory
from service.maps.snapshot import MapSnapshot


class Session(Protocol):
    """Earlier requests of one robot."""

    def evidence(self, snapshot: MapSnapshot, middle: Float64) -> Evidence | None:
        """Return the evidence of the earlier requests in a map; None if there is none.

        Args:
            snapshot: the map.
            middle: middle of the segments that the robot sees now (`middle_of`), (3,).
        """

    def remember(
        self, snapshot: MapSnapshot, middle: Float64, hypotheses: Sequence[Hypothesis]
    ) -> None:
        """Add the hypotheses that one request found in a map by itself."""


@dataclass(frozen=True, slots=True)
class SessionKey:
    """Key of a session in one map; evidence counts for the same key only.

    Attributes:
        principal: name of the API key that the requests came with.
        session: id that the robot chose.
        map: uid of the map: another map of the same name has another frame.
        frame_since: version of the map since which its frame is the same.
    """

    principal: str
    session: str
    map: str
    frame_since: int


class Sessions:
    """Sessions of all API keys. Safe to use from many threads.

    A session without a request for longer than the memory is dropped. If there are too many
    sessions, the API key with most of them loses its oldest one. So no API key can displace the
    sessions of another that has fewer.
    """

    def __init__(
        self,
        most: int,
        parameters: LocalizationParameters | None = None,
        clock: Callable[[], float] = monotonic,
    ) -> None:
        """Create the sessions, without any.

        Args:
            most: largest number of sessions; each map of a session counts as one.
            parameters: state how long and how much is remembered.
            clock: monotonic clock, seconds.
        """
        self._most = most
        self._parameters = parameters or LocalizationParameters()
        self._clock = clock
        self._lock = Lock()
        # The last used session is at the end, in both: of all API keys, and of each.
        self._by_key: OrderedDict[SessionKey, tuple[float, RequestHistory]] = OrderedDict()
        self._of_principal: defaultdict[str, OrderedDict[SessionKey, None]] = defaultdict(
            OrderedDict
        )

    def __len__(self) -> int:
        return len(self._by_key)

    def evidence(self, key: SessionKey, middle: Float64) -> Evidence | None:
        """Return the evidence of a session's earlier requests; None if there is none.

        Args:
            key: key of the session.
            middle: middle of the segments that the robot sees now (`middle_of`), (3,).
        """
        with self._lock:
            now = self._clock()
            known = self._by_key.get(key)
            return known[1].at(now, middle) if known is not None else None

    def remember(self, key: SessionKey, middle: Float64, hypotheses: Sequence[Hypothesis]) -> None:
        """Add the hypotheses that one request found by itself."""
        with self._lock:
            now = self._clock()
            _, history = self._by_key.get(key) or (now, RequestHistory(self._parameters))
            history.add(now, middle, hypotheses)
            self._by_key[key] = now, history
            self._by_key.move_to_end(key)
            own = self._of_principal[key.principal]
            own[key] = None
            own.move_to_end(key)
            while self._by_key:
                oldest, (last, _) = next(iter(self._by_key.items()))
                if now - last <= self._parameters.memory:
                    break
                self._drop(oldest)
            while len(self._by_key) > self._most:
                largest = max(self._of_principal.values(), key=len)
                self._drop(next(iter(largest)))

    def _drop(self, key: SessionKey) -> None:
        del self._by_key[key]
        own = self._of_principal[key.principal]
        del own[key]
        if not own:
            del self._of_principal[key.principal]


@dataclass(frozen=True, slots=True)
class RobotSession:
    """Session of one robot, in all maps.

    Attributes:
        sessions: sessions of all robots.
        principal: name of the API key that the requests come with.
        id: id that the robot chose.
    """

    sessions: Sessions
    principal: str
    id: str

    def evidence(self, snapshot: MapSnapshot, middle: Float64) -> Evidence | None:
        """Return the evidence of the earlier requests in a map; see `Session`."""
        return self.sessions.evidence(self._key(snapshot), middle)

    def remember(
        self, snapshot: MapSnapshot, middle: Float64, hypotheses: Sequence[Hypothesis]
    ) -> None:
        """Add the hypotheses that one request found in a map by itself."""
        self.sessions.remember(self._key(snapshot), middle, hypotheses)

    def _key(self, snapshot: MapSnapshot) -> SessionKey:
        return SessionKey(self.principal, self.id, snapshot.head.uid, snapshot.frame_since)
