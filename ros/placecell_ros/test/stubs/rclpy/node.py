from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, ClassVar

import rclpy
from rclpy.qos import QoSProfile


@dataclass
class Parameter:
    name: str
    value: Any


@dataclass
class Publisher:
    kind: Any
    topic: str
    quality: int | QoSProfile
    messages: list[Any] = field(default_factory=list)

    def publish(self, message: Any) -> None:
        if not rclpy.ok():
            raise RuntimeError("the context is invalid")
        assert isinstance(message, self.kind)
        self.messages.append(message)


@dataclass
class Logger:
    lines: list[str] = field(default_factory=list)

    def info(self, text: str) -> None:
        self.lines.append(f"info: {text}")

    def warning(self, text: str) -> None:
        self.lines.append(f"warning: {text}")

    def fatal(self, text: str) -> None:
        self.lines.append(f"fatal: {text}")


class Node:
    given: ClassVar[dict[str, Any]] = {}
    """Values of parameters, as a launch file gives them."""
    to_spin: ClassVar[list[Callable[["Node"], None]]] = []
    newest: ClassVar["Node | None"] = None

    def __init__(self, name: str) -> None:
        self.name = name
        self.parameters: dict[str, Any] = {}
        self.publishers: dict[str, Publisher] = {}
        self.subscriptions: dict[str, tuple[Any, Callable[[Any], None], Any]] = {}
        self.services: dict[str, tuple[Any, Callable[[Any, Any], Any]]] = {}
        self.logger = Logger()
        self.is_destroyed = False
        Node.newest = self

    def declare_parameter(self, name: str, value: Any) -> Parameter:
        assert type(value) in (bool, int, float, str), f"no parameter can hold {value!r}"
        given = self.given.get(name, value)
        assert type(given) is type(value), f"{name}: {given!r} has another type than {value!r}"
        self.parameters[name] = given
        return Parameter(name, given)

    def create_publisher(self, kind: Any, topic: str, quality: int | QoSProfile) -> Publisher:
        self.publishers[topic] = Publisher(kind, topic, quality)
        return self.publishers[topic]

    def create_subscription(
        self, kind: Any, topic: str, receive: Callable[[Any], None], quality: Any
    ) -> None:
        self.subscriptions[topic] = kind, receive, quality

    def create_service(self, kind: Any, name: str, serve: Callable[[Any, Any], Any]) -> None:
        self.services[name] = kind, serve

    def get_logger(self) -> Logger:
        return self.logger

    def destroy_node(self) -> None:
        self.is_destroyed = True
