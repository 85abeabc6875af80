"""Address of a live source over Zenoh: `zenoh://HOST:PORT?points=/points&odom=/odom`."""

import re
from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any
from urllib.parse import parse_qsl, urlsplit

SCHEME = "zenoh"
ROUTER = "localhost:7447"
"""Address at which rmw_zenoh's router listens by default."""
TOPIC = r"/\w+(/\w+)*"
FORM = "zenoh://HOST:PORT?points=/TOPIC&odom=/TOPIC"


@dataclass(frozen=True, slots=True)
class ZenohAddress:
    """Endpoints and topics of a node over Zenoh.

    Attributes:
        connect: endpoints to connect to, such as `tcp/192.168.1.7:7447`.
        listen: endpoints to listen on.
        domain: ROS_DOMAIN_ID.
        points: topic of the clouds, sensor_msgs/PointCloud2.
        odom: topic of the odometry, nav_msgs/Odometry.
        tf: topic on which `map -> odom` is published, tf2_msgs/TFMessage.
        tf_static: topic of the transforms between the robot's frames, tf2_msgs/TFMessage.
        initialpose: topic of poses that a person gives, PoseWithCovarianceStamped.
        pose: topic of the robot's pose in the map, PoseWithCovarianceStamped.
        diagnostics: topic of the agent's state, diagnostic_msgs/DiagnosticArray.
        map_frame: name of the map's frame.
        node: name of the node.
        distro: ROS 2 distribution of the other nodes; `humble` has no type hashes.
    """

    connect: tuple[str, ...] = ()
    listen: tuple[str, ...] = ()
    domain: int = 0
    points: str = "/points"
    odom: str = "/odom"
    tf: str = "/tf"
    tf_static: str = "/tf_static"
    initialpose: str = "/initialpose"
    pose: str = "/placecell/pose"
    diagnostics: str = "/diagnostics"
    map_frame: str = "map"
    node: str = "placecell"
    distro: str = ""

    @classmethod
    def of(cls, text: str) -> "ZenohAddress":
        """Parse an address.

        Raises:
            ValueError: the address has another scheme, an unknown key, or an invalid value.
        """
        parts = urlsplit(text)
        if parts.scheme != SCHEME:
            raise ValueError(f"Invalid address {text!r}: expected {FORM}.")
        known = {each.name for each in fields(cls)} - {"connect"}
        values: dict[str, Any] = {"listen": ()}
        for key, value in parse_qsl(parts.query, keep_blank_values=True):
            if key not in known:
                raise ValueError(
                    f"Unknown key {key!r} in {text!r}: expected {', '.join(sorted(known))}."
                )
            check = CHECKS.get(key, is_topic)
            if not check(value):
                raise ValueError(f"Invalid {key} {value!r} in {text!r}: expected {FORMS[check]}.")
            if key == "listen":
                values[key] += (value,)
            else:
                values[key] = int(value) if key == "domain" else value
        if parts.netloc:
            host = parts.netloc if re.search(r":\d+$", parts.netloc) else f"{parts.netloc}:7447"
            values["connect"] = (f"tcp/{host}",)
        elif not values["listen"]:
            values["connect"] = (f"tcp/{ROUTER}",)
        return cls(**values)


def is_topic(text: str) -> bool:
    """Return whether a text is the absolute name of a topic."""
    return re.fullmatch(TOPIC, text) is not None


def is_domain(text: str) -> bool:
    """Return whether a text is a ROS_DOMAIN_ID."""
    return re.fullmatch(r"\d{1,3}", text) is not None and int(text) <= 232


def is_endpoint(text: str) -> bool:
    """Return whether a text is an endpoint of Zenoh."""
    return re.fullmatch(r"(tcp|udp|tls|quic|ws|unixsock-stream)/\S+", text) is not None


def is_name(text: str) -> bool:
    """Return whether a text is the name of a node or a frame."""
    return re.fullmatch(r"\w+", text) is not None


CHECKS: dict[str, Callable[[str], bool]] = {
    "listen": is_endpoint,
    "domain": is_domain,
    "map_frame": is_name,
    "node": is_name,
    "distro": is_name,
}
FORMS: dict[Callable[[str], bool], str] = {
    is_topic: "the absolute name of a topic, such as /points",
    is_domain: "a number from 0 to 232",
    is_endpoint: "an endpoint of Zenoh, such as tcp/0.0.0.0:7447",
    is_name: "letters, digits and underscores",
}
