"""Session of Zenoh that speaks like a node of ROS 2: subscriptions and publishers of topics."""

import json
import time
from collections.abc import Callable, Sequence
from types import TracebackType
from typing import Any, Self

from robot.zenoh.rmw import (
    TopicType,
    attachment,
    node_token,
    publisher_id,
    reply_attachment,
    topic_of_token,
    topic_token,
)

MISSING = "Zenoh needs the packages eclipse-zenoh and rosbags: pip install 'placecell[zenoh]'."


class ZenohError(OSError):
    """Error: the session of Zenoh cannot be opened."""


class MissingZenohError(ZenohError):
    """Error: the packages of the extra `zenoh` are not installed."""


def zenoh_modules() -> tuple[Any, Any]:
    """Return the modules `zenoh` and `zenoh.ext`.

    Raises:
        MissingZenohError: they are not installed.
    """
    try:
        import rosbags.typesys  # noqa: F401
        import zenoh
        import zenoh.ext
    except ImportError as error:
        raise MissingZenohError(f"{MISSING} ({error})") from error
    return zenoh, zenoh.ext


class BusPublisher:
    """Publisher of one topic."""

    def __init__(self, publisher: Any, token: str) -> None:
        self._publisher = publisher
        self._id = publisher_id(token)
        self._sequence = 0

    def put(self, data: bytes) -> None:
        """Publish a message."""
        self._sequence += 1
        extra = attachment(self._sequence, time.time_ns(), self._id)
        self._publisher.put(data, attachment=extra)


class ZenohBus:
    """Session of Zenoh with one node.

    Peers find each other through a router, such as that of rmw_zenoh, or through endpoints that
    they connect to; multicast is off, as in rmw_zenoh.
    """

    def __init__(
        self, node: str, domain: int, connect: Sequence[str] = (), listen: Sequence[str] = ()
    ) -> None:
        """Open the session; endpoints that do not answer yet are tried again.

        Args:
            node: name of the node.
            domain: ROS_DOMAIN_ID.
            connect: endpoints to connect to, such as `tcp/127.0.0.1:7447`.
            listen: endpoints to listen on; none: a free port of the loopback interface.

        Raises:
            MissingZenohError: Zenoh is not installed.
            ZenohError: the session cannot be opened.
        """
        self._zenoh, self._ext = zenoh_modules()
        config = self._zenoh.Config()
        for key, value in {
            "mode": "peer",
            "connect/endpoints": list(connect),
            "connect/exit_on_failure": False,
            "connect/timeout_ms": -1,  # tries again in the background, also after a restart
            "connect/retry": {"period_init_ms": 200, "period_max_ms": 2000},
            "listen/endpoints": list(listen) or ["tcp/127.0.0.1:0"],
            "scouting/multicast/enabled": False,
            "scouting/gossip/enabled": True,
            "timestamping/enabled": True,  # as in rmw_zenoh; the last messages of a topic need it
        }.items():
            config.insert_json5(key, json.dumps(value))
        self._node, self._domain = node, domain
        try:
            self._session = self._zenoh.open(config)
        except self._zenoh.ZError as error:
            raise ZenohError(
                f"Zenoh cannot open a session that listens on {list(listen) or 'a free port'}: "
                f"{error}. Check the endpoints, and that no other program uses the port."
            ) from error
        self._zid = str(self._session.info.zid())
        self._held: list[Any] = []
        self._entities = 0
        self._hold(node_token(domain, self._zid, node))

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the session; its tokens and subscriptions end."""
        self._session.close()

    def _hold(self, token: str) -> None:
        """Declare a liveliness token for the life of the session."""
        self._held.append(self._session.liveliness().declare_token(token))

    def _token(self, kind: Any, topic: TopicType) -> str:
        self._entities += 1
        token = topic_token(self._domain, self._zid, self._node, kind, self._entities, topic)
        self._hold(token)
        return token

    def publisher(self, topic: TopicType) -> BusPublisher:
        """Declare a publisher."""
        key = topic.key(self._domain)
        if topic.quality.transient_local:
            declared = self._ext.declare_advanced_publisher(
                self._session,
                key,
                cache=self._ext.CacheConfig(max_samples=topic.quality.depth),
                publisher_detection=True,
            )
        else:
            declared = self._session.declare_publisher(key)
        self._held.append(declared)  # a publisher ends with its last reference
        return BusPublisher(declared, self._token("MP", topic))

    def subscribe(self, topic: TopicType, receive: Callable[[bytes], None]) -> None:
        """Call a function with each message of a topic, from a thread of Zenoh."""

        def take(sample: Any) -> None:
            receive(sample.payload.to_bytes())

        key = topic.any_key(self._domain)
        if topic.quality.transient_local:
            history = self._ext.HistoryConfig(detect_late_publishers=True)
            declared = self._ext.declare_advanced_subscriber(
                self._session, key, take, history=history
            )
        else:
            declared = self._session.declare_subscriber(key, take)
        self._held.append(declared)
        self._token("MS", topic)

    def serve(self, service: TopicType, answer: Callable[[bytes], bytes]) -> None:
        """Answer the requests of a service with a function, from a thread of Zenoh."""

        def take(query: Any) -> None:
            request = b"" if query.payload is None else query.payload.to_bytes()
            asked = None if query.attachment is None else query.attachment.to_bytes()
            extra = reply_attachment(asked, time.time_ns())
            query.reply(query.key_expr, answer(request), attachment=extra)

        # Clients of rmw_zenoh ask complete queryables only.
        key = service.any_key(self._domain)
        self._held.append(self._session.declare_queryable(key, take, complete=True))
        self._token("SS", service)

    def topics(self, seconds: float = 1.0) -> dict[str, str]:
        """Return the type of each topic that is published on the domain, by its name."""
        found = {}
        for reply in self._session.liveliness().get(f"@ros2_lv/{self._domain}/**", timeout=seconds):
            if reply.ok is not None:
                named = topic_of_token(str(reply.ok.key_expr))
                if named is not None and named[0] == "MP":
                    found[named[1]] = named[2]
        return found
