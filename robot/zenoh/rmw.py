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

EntityKind = Literal["NN", "MP", "MS"]
"""Node, publisher and subscription."""


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
    """Topic with its type.

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
        """Return the key expression of the topic with any hash, for subscriptions."""
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
        kind: `MP` or `MS`.
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


def attachment(sequence: int, time_ns: int, publisher: bytes) -> bytes:
    """Return the attachment of a message.

    Args:
        sequence: number of the message of its publisher, from 1.
        time_ns: time of publishing, nanoseconds since the epoch.
        publisher: id of the publisher, 16 bytes.
    """
    return struct.pack("<qqB", sequence, time_ns, len(publisher)) + publisher
