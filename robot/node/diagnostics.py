"""Diagnostics of the agent: level, words and figures of its state."""

from robot.core.status import AgentState, AgentStatus, LinkState
from robot.node.messages import Diagnostic, DiagnosticLevel

LEVELS = {
    AgentState.STARTING: DiagnosticLevel.WARN,
    AgentState.LOCALIZING: DiagnosticLevel.WARN,
    AgentState.TRACKING: DiagnosticLevel.OK,
    AgentState.OUTSIDE: DiagnosticLevel.WARN,
    AgentState.LOST: DiagnosticLevel.ERROR,
    AgentState.KIDNAPPED: DiagnosticLevel.ERROR,
    AgentState.MAPPING: DiagnosticLevel.OK,
}


def diagnostic_of(
    status: AgentStatus,
    robot: str,
    stamp_ns: int,
    problem: str,
    counts: tuple[tuple[str, int], ...],
) -> Diagnostic:
    """Build the diagnostic of a state.

    Args:
        status: state of the agent.
        robot: name of the robot.
        stamp_ns: time of the last message, nanoseconds.
        problem: problem of the input that stops the agent; empty if there is none.
        counts: numbers of scans and messages of the node.
    """
    level = LEVELS[status.state]
    message = f"{status.state.value}: {status.reason}" if status.reason else status.state.value
    if status.link is LinkState.OFFLINE:
        level = max(level, DiagnosticLevel.WARN)
        message += "; no link to the service"
    if problem:
        level, message = DiagnosticLevel.ERROR, problem
    fix = status.last_fix
    values = [
        ("state", status.state.value),
        ("reason", status.reason),
        ("link", status.link.value),
        ("map", status.map),
        ("upload_map", status.upload_map),
        ("meters", f"{status.meters:.1f}"),
        ("scans", str(status.scans)),
        ("fixes", str(status.fixes)),
        ("seconds_since_fix", "" if fix is None else f"{status.time - fix.time:.1f}"),
        ("fix_probability", "" if fix is None else f"{fix.probability:.4f}"),
        ("spool_edits", str(status.spool.entries)),
        ("spool_bytes", str(status.spool.bytes)),
        *((name, str(count)) for name, count in counts),
    ]
    return Diagnostic(stamp_ns, level, "placecell: localization", message, robot, tuple(values))
