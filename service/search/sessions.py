"""Sessions: what each robot's last requests found, for its next one."""

from collections import OrderedDict, defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from threading import Lock
from time import monotonic

from placecell.core.types import Float64
from placecell.localization import Hypothesis, LocalizationParameters
from placecell.localization.evidence import Evidence, History


@dataclass(frozen=True, slots=True)
class SessionKey:
    """Whose evidence it is: nobody's counts for another's.

    Attributes:
        holder: name of the key that the requests came with.
        session: the id that the robot chose.
        map: uid of the map: another of its name lies elsewhere.
        frame_since: of the map; what was replaced may lie elsewhere, too.
    """

    holder: str
    session: str
    map: str
    frame_since: int


class Sessions:
    """The sessions of all keys. Safe to use from many threads.

    A session that was silent longer than the memory is dropped. Of too many at once, the key that
    has most of them loses the one that was silent longest; so no key can displace the sessions of
    another that has fewer.
    """

    def __init__(
        self,
        most: int,
        parameters: LocalizationParameters | None = None,
        clock: Callable[[], float] = monotonic,
    ) -> None:
        """None yet.

        Args:
            most: sessions at once; a map counts as one of its own.
            parameters: how long and how much is remembered.
            clock: gives seconds that only grow.
        """
        self._most = most
        self._parameters = parameters or LocalizationParameters()
        self._clock = clock
        self._lock = Lock()
        # Those used last stand at the end, of all keys and of each.
        self._by_key: OrderedDict[SessionKey, tuple[float, History]] = OrderedDict()
        self._of_holder: defaultdict[str, OrderedDict[SessionKey, None]] = defaultdict(OrderedDict)

    def __len__(self) -> int:
        return len(self._by_key)

    def evidence(self, key: SessionKey, middle: Float64) -> Evidence | None:
        """What the session's earlier requests say now; None if there is none.

        Args:
            key: of the session.
            middle: (3,), of what is seen now (`middle_of`).
        """
        with self._lock:
            now = self._clock()
            known = self._by_key.get(key)
            return known[1].at(now, middle) if known is not None else None

    def remember(self, key: SessionKey, middle: Float64, hypotheses: Sequence[Hypothesis]) -> None:
        """Add what a request found by itself."""
        with self._lock:
            now = self._clock()
            _, history = self._by_key.get(key) or (now, History(self._parameters))
            history.add(now, middle, hypotheses)
            self._by_key[key] = now, history
            self._by_key.move_to_end(key)
            own = self._of_holder[key.holder]
            own[key] = None
            own.move_to_end(key)
            while self._by_key:
                oldest, (last, _) = next(iter(self._by_key.items()))
                if now - last <= self._parameters.memory:
                    break
                self._drop(oldest)
            while len(self._by_key) > self._most:
                largest = max(self._of_holder.values(), key=len)
                self._drop(next(iter(largest)))

    def _drop(self, key: SessionKey) -> None:
        del self._by_key[key]
        own = self._of_holder[key.holder]
        del own[key]
        if not own:
            del self._of_holder[key.holder]
