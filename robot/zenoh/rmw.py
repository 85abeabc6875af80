"""Names on the wire of `rmw_zenoh`: key expressions, liveliness tokens, attachments.

A topic is the key `DOMAIN/TOPIC/TYPE/HASH`. Nodes, publishers and subscriptions are seen by
`ros2 node list` and `ros2 topic list` because each declares a liveliness token. A message without
an attachment is dropped by the subscriptions of ROS 2.
"""

import hashlib
import re
import struct
from dataclasses import dataclass
from typing import Literal

NO_HASH = "TypeHashNotSupported"
"""Hash of every type in ROS 2 Humble, which has no type hashes."""

CLIENT_BYTES = 16
"""Length of the id of a publisher or a client."""
ATTACHMENT_BYTES = 17 + CLIENT_BYTES

EntityKind = Literal["NN", "MP", "MS", "SS"]
"""Node, publisher, subscription and server of a service."""


@dataclass(frozen=True, slots=True)
class Quality:
    """Quality of service of a topic, as far as the node needs it.

    Attributes:
        depth: messages that a queue keeps.
        best_effort: lost messages are not sent again.
        transient_local: late subscriptions get the last messages.
    """

    depth: int
    best_effort: bool = False
    transient_local: bool = False

    def __str__(self) -> str:
        """Return the text of a liveliness token; what is the default stays empty."""
        reliability, durability = "2" * self.best_effort, "1" * self.transient_local
        return f"{reliability}:{durability}:,{self.depth}:,:,:,,"


@dataclass(frozen=True, slots=True)
class TopicType:
    """Topic or service with its type.

    Attributes:
        name: absolute name, such as `/points`.
        type: type, such as `sensor_msgs/msg/PointCloud2`.
        hash: hash of the type, `RIHS01_...`, or `NO_HASH`.
        quality: quality of service.
    """

    name: str
    type: str
    hash: str
    quality: Quality

    @property
    def dds_type(self) -> str:
        """Name of the type on the wire, such as `sensor_msgs::msg::dds_::PointCloud2_`."""
        package, kind, name = self.type.split("/")
        return f"{package}::{kind}::dds_::{name}_"

    def key(self, domain: int) -> str:
        """Return the key on which messages are published."""
        return f"{domain}/{self.name.strip('/')}/{self.dds_type}/{self.hash}"

    def any_key(self, domain: int) -> str:
        """Return the key expression of the topic with any hash, for subscriptions and servers."""
        return f"{domain}/{self.name.strip('/')}/{self.dds_type}/*"


def mangled(name: str) -> str:
    """Return a name as one part of a key."""
    return name.replace("/", "%")


def node_token(domain: int, zid: str, node: str) -> str:
    """Return the liveliness token of a node; its id is 0."""
    return f"@ros2_lv/{domain}/{zid}/0/0/NN/%/%/{mangled(node)}"


def topic_token(
    domain: int, zid: str, node: str, kind: EntityKind, number: int, topic: TopicType
) -> str:
    """Return the liveliness token of a publisher or a subscription.

    Args:
        domain: ROS_DOMAIN_ID.
        zid: id of the session.
        node: name of the node.
        kind: `MP`, `MS` or `SS`.
        number: id of the publisher or subscription within the session, from 1.
        topic: topic.
    """
    return (
        f"@ros2_lv/{domain}/{zid}/0/{number}/{kind}/%/%/{mangled(node)}/{mangled(topic.name)}/"
        f"{topic.dds_type}/{topic.hash}/{topic.quality}"
    )


def topic_of_token(token: str) -> tuple[EntityKind, str, str] | None:
    """Return kind, topic and type of another program's token; None for other tokens."""
    found = re.fullmatch(
        r"@ros2_lv/\d+/[^/]+/\d+/\d+/(MP|MS)/[^/]+/[^/]+/[^/]+/([^/]+)/([^/]+)/.*", token
    )
    if found is None:
        return None
    kind: EntityKind = "MP" if found[1] == "MP" else "MS"
    named = re.fullmatch(r"(\w+)::(\w+)::dds_::(\w+)_", found[3])
    return kind, found[2].replace("%", "/"), "/".join(named.groups()) if named else found[3]


def publisher_id(token: str) -> bytes:
    """Return the id of a publisher, 16 bytes that are unique to its token."""
    return hashlib.blake2b(token.encode(), digest_size=16).digest()


def reply_attachment(request: bytes | None, time_ns: int) -> bytes:
    """Return the attachment of a response: sequence number and client are those of the request.

    Args:
        request: attachment of the request; None: the request has none, so no client waits for them.
        time_ns: time of the response, nanoseconds since the epoch.
    """
    if request is None or len(request) != ATTACHMENT_BYTES or request[16] != CLIENT_BYTES:
        return attachment(0, time_ns, bytes(CLIENT_BYTES))
    (sequence,) = struct.unpack_from("<q", request)
    return attachment(sequence, time_ns, request[17:])


def attachment(sequence: int, time_ns: int, publisher: bytes) -> bytes:
    """Return the attachment of a message.

    Args:
        sequence: number of the message of its publisher, from 1.
        time_ns: time of publishing, nanoseconds since the epoch.
        publisher: id of the publisher, 16 bytes.
    """
    return struct.pack("<qqB", sequence, time_ns, len(publisher)) + publisher
