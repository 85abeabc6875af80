"""Process that receives the agent's messages over Zenoh, as navigation does.

Usage: python -m tests.robot.zenoh.receiver_process ENDPOINT SECONDS

It ends when `map -> odom`, a pose and the state `tracking` have arrived, and prints them as JSON.
"""

import json
import sys
import threading
from typing import Any

from robot.zenoh import cdr
from robot.zenoh.address import ZenohAddress
from robot.zenoh.bus import ZenohBus
from robot.zenoh.node import RELIABLE, TRANSFORM, topic


def main(endpoint: str, seconds: str) -> int:
    """Receive until all is there; return 1 if it is not in time."""
    address = ZenohAddress(connect=(endpoint,))
    changed = threading.Condition()
    found: dict[str, Any] = {"states": []}

    def take_transforms(data: bytes) -> None:
        for each in cdr.read_transforms(data, address.tf):
            note(frames=[each.parent, each.child], transform=each.pose.tolist())

    def take_pose(data: bytes) -> None:
        note(position=cdr.read_pose(data, address.pose).pose[:2, 3].tolist())

    def take_state(data: bytes) -> None:
        status = cdr.type_store().deserialize_cdr(data, cdr.DIAGNOSTICS).status[0]
        state = {each.key: each.value for each in status.values}["state"]
        print(status.message, file=sys.stderr)
        note(states=[*found["states"], state])

    def note(**what: Any) -> None:
        with changed:
            found.update(what)
            changed.notify()

    def is_complete() -> bool:
        return {"transform", "position"} <= {*found} and found["states"][-1:] == ["tracking"]

    with ZenohBus("receiver", 0, connect=[endpoint]) as bus:
        bus.subscribe(topic(address, address.tf, cdr.TRANSFORMS, TRANSFORM), take_transforms)
        bus.subscribe(topic(address, address.pose, cdr.POSE, RELIABLE), take_pose)
        bus.subscribe(topic(address, address.diagnostics, cdr.DIAGNOSTICS, RELIABLE), take_state)
        with changed:
            complete = changed.wait_for(is_complete, float(seconds))
        found["topics"] = bus.topics()
    print(json.dumps(found))
    return 0 if complete else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
