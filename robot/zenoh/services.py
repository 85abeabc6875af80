"""Services of ROS 2 on the wire of `rmw_zenoh`: the hashes of their types, and their responses."""

import struct
from functools import cache
from typing import Any

TRIGGER = "std_srvs/srv/Trigger"
TRIGGER_RESPONSE = "bool success\nstring message\n"

EVENT_INFO = "service_msgs/msg/ServiceEventInfo"
EVENT_INFO_DEFINITION = """uint8 event_type
builtin_interfaces/Time stamp
uint8[16] client_gid
int64 sequence_number
"""
"""Header of the events of all services. ROS 2 writes `char`, which is hashed as uint8."""

LITTLE_ENDIAN = b"\x00\x01\x00\x00"
"""First four bytes of CDR."""


def service_hash(kind: str, request: str, response: str) -> str:
    """Return the hash of a service's type, as REP-2016 defines it.

    The type has three members: request, response, and an event, which has a header and at most one
    request and one response.

    Args:
        kind: type, such as `std_srvs/srv/Trigger`.
        request: definition of the request.
        response: definition of the response.
    """
    from rosbags.interfaces import Nodetype
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    # An own store: `rosbags` would register a service's messages under other names.
    store = get_typestore(Stores.ROS2_HUMBLE)
    known: Any = store.fielddefs
    definitions = {
        EVENT_INFO: EVENT_INFO_DEFINITION,
        f"{kind}_Request": request,
        f"{kind}_Response": response,
    }
    for name, text in definitions.items():
        (known[name],) = get_types_from_msg(text, name).values()
    parts = [(Nodetype.NAME, f"{kind}_{part}") for part in ("Request", "Response", "Event")]
    asked, answered, event = parts
    fields = [
        ("info", (Nodetype.NAME, EVENT_INFO)),
        ("request", (Nodetype.SEQUENCE, (asked, 1))),
        ("response", (Nodetype.SEQUENCE, (answered, 1))),
    ]
    known[event[1]] = ([], fields)
    members = ("request_message", "response_message", "event_message")
    known[kind] = ([], list(zip(members, parts, strict=True)))
    return str(store.hash_rihs01(kind))


@cache
def trigger_hash() -> str:
    """Return the hash of std_srvs/Trigger."""
    return service_hash(TRIGGER, "", TRIGGER_RESPONSE)


def write_trigger_response(success: bool, message: str) -> bytes:
    """Write the response of a std_srvs/Trigger."""
    text = message.encode() + b"\0"
    return LITTLE_ENDIAN + struct.pack("<B3xI", success, len(text)) + text
