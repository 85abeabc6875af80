"""State machine of localization. `docs/explanation/robot-agent.md` draws it."""

from robot.core.status import AgentState
from robot.localization.correction import Verdict

STATE = AgentState


class LocalizationState:
    """State of localization, and why it is so. Each method is an event.

    Attributes:
        state: the state.
        reason: why it is so, in words.
    """

    def __init__(self) -> None:
        self.state = STATE.STARTING
        self.reason = "no scan yet"
        self._before_doubt: tuple[AgentState, str] | None = None

    def started(self, localizes: bool) -> None:
        """Note the first scan."""
        if localizes:
            self._enter(STATE.LOCALIZING, "no fix yet")
        else:
            self._enter(STATE.MAPPING, "localization is off")

    def own_map(self, name: str) -> None:
        """Note that the map to localize in is the one that this robot makes now."""
        self._enter(STATE.MAPPING, f"map {name!r} is made by this robot, in its odometry frame")

    def fixed(self, verdict: Verdict) -> None:
        """Note a fix and how it relates to the pose."""
        if self.state is STATE.MAPPING:
            return
        match verdict:
            case "first":
                self._enter(STATE.TRACKING, "two fixes agree")
            case "confirmed":
                self._enter(STATE.TRACKING, "the last fix agrees with the odometry")
            case "jump":
                self._enter(STATE.TRACKING, "two fixes agree on another place than before")
            case "contradicts":
                if self.state is not STATE.OUTSIDE:
                    self._enter(STATE.LOST, "the last fix contradicts the odometry")
            case "unconfirmed":
                self.reason = "one fix, which no other confirms yet"

    def missed(self, reason: str, outside: bool | None, uncertain: bool) -> None:
        """Note a request without a fix.

        Args:
            reason: why there is none.
            outside: whether the pose is outside the mapped area; None: it is not known.
            uncertain: whether the pose has become too uncertain since the last fix.
        """
        if self.state in (STATE.LOCALIZING, STATE.KIDNAPPED):
            self.reason = reason
        elif self.state in (STATE.TRACKING, STATE.OUTSIDE, STATE.LOST):
            if outside:
                self._enter(STATE.OUTSIDE, "the mapped area is left behind")
            elif uncertain:
                self._enter(STATE.LOST, f"no fix for a long way: {reason}")

    def doubted(self) -> None:
        """Note that a scan does not fit the last one; the next scan decides."""
        if self.state in (STATE.TRACKING, STATE.OUTSIDE):
            self._before_doubt = self.state, self.reason
            self._enter(STATE.LOST, "a scan does not fit the one before")

    def cleared(self) -> None:
        """Note that the scan after a doubtful one fits again."""
        if self._before_doubt is not None:
            self._enter(*self._before_doubt)

    def carried_away(self) -> None:
        """Note that the scans show another place than the odometry."""
        if self.state in (STATE.STARTING, STATE.MAPPING):
            return
        self._enter(STATE.KIDNAPPED, "the scans do not fit those before: another place")

    def map_replaced(self, name: str) -> None:
        """Note that another map has the name now."""
        if self.state is not STATE.MAPPING:
            self._enter(STATE.LOCALIZING, f"map {name!r} was replaced by another one")

    def relocalize(self, reason: str) -> None:
        """Note that the pose is not known any more."""
        self._enter(STATE.LOCALIZING, reason)

    def placed(self) -> None:
        """Note a pose that a person gave."""
        self._enter(STATE.TRACKING, "an operator gave the pose")

    def _enter(self, state: AgentState, reason: str) -> None:
        self.state, self.reason = state, reason
        self._before_doubt = None
