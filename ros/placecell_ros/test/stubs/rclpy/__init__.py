"""Stand-in for rclpy: what the node uses of it, in one process and without messages on a wire."""

from typing import Any

STATE = {"ok": False}


def init(args: list[str] | None = None) -> None:
    STATE["ok"] = True


def ok() -> bool:
    return STATE["ok"]


def try_shutdown() -> None:
    STATE["ok"] = False


def spin(node: Any) -> None:
    """Call what the test left on the node, as an executor calls what arrives."""
    from rclpy.executors import ExternalShutdownException

    for call in node.to_spin:
        call(node)
    raise ExternalShutdownException
