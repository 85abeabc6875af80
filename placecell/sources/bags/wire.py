"""Serialization of messages in bags: ROS 1, and CDR of ROS 2.

Both write the values of a message one behind the other. ROS 1 has no padding. CDR begins with four
bytes that state the byte order, aligns each value to its size, and ends strings with a zero.
"""

import struct
from collections.abc import Callable
from typing import TypeVar

import numpy as np

from placecell.core.types import Float64
from placecell.sources.errors import DriveError

T = TypeVar("T")

CDR_ORDERS = {b"\x00\x00": ">", b"\x00\x01": "<", b"\x00\x06": ">", b"\x00\x07": "<"}
"""Byte order of each known encapsulation: CDR, and plain CDR2 of newer middlewares."""
SIZES = {"B": 1, "b": 1, "H": 2, "I": 4, "i": 4, "Q": 8, "f": 4, "d": 8}


class Wire:
    """Cursor over a serialized message; reads values in their order.

    Args:
        data: the message.
        encoding: `ros1` or `cdr`.
        where: file, topic and message, for errors.
    """

    def __init__(self, data: bytes | memoryview, encoding: str, where: str) -> None:
        self.data = memoryview(data)
        self.where = where
        self.ros1 = encoding == "ros1"
        self.order = "<"
        self.largest = 8
        self.origin = self.at = 0
        if not self.ros1:
            kind = bytes(self.data[:2])
            if kind not in CDR_ORDERS or len(self.data) < 4:
                raise DriveError(
                    f"{where}: the message begins with {bytes(self.data[:4]).hex() or 'nothing'}; "
                    "expected the header of CDR, 00010000. The message is damaged"
                )
            self.order = CDR_ORDERS[kind]
            self.largest = 4 if kind[1] >= 6 else 8
            self.origin = self.at = 4

    def take(self, size: int, what: str) -> memoryview:
        """Return the next bytes.

        Raises:
            DriveError: the message ends before them.
        """
        end = self.at + size
        if end > len(self.data):
            raise DriveError(
                f"{self.where}: {what} of {size} bytes begins at byte {self.at}, but the message "
                f"has {len(self.data)} bytes. It is cut short, or of another type than its topic "
                "states"
            )
        taken = self.data[self.at : end]
        self.at = end
        return taken

    def align(self, size: int) -> None:
        """Skip padding before a value of this size."""
        if not self.ros1:
            self.at += (self.origin - self.at) % min(size, self.largest)

    def value(self, kind: str) -> int:
        """Return an integer; `kind` is its letter in `struct`."""
        self.align(SIZES[kind])
        taken = self.take(SIZES[kind], "a value")
        return int(struct.unpack(self.order + kind, taken)[0])

    def u32(self) -> int:
        """Return an uint32."""
        return self.value("I")

    def u8(self) -> int:
        """Return an uint8."""
        return self.value("B")

    def doubles(self, count: int) -> Float64:
        """Return float64 values."""
        self.align(8)
        values = np.frombuffer(self.take(8 * count, "values"), self.order + "f8")
        return values.astype(np.float64)

    def string(self) -> str:
        """Return a string; bytes that are no UTF-8 are replaced."""
        text = bytes(self.take(self.u32(), "a string"))
        return text.rstrip(b"\0").decode(errors="replace")

    def bytes(self) -> memoryview:
        """Return an array of bytes: a view into the message."""
        return self.take(self.u32(), "an array")

    def time_ns(self) -> int:
        """Return a time in nanoseconds."""
        seconds = self.value("I" if self.ros1 else "i")
        return seconds * 10**9 + self.u32()

    def header(self) -> tuple[int, str]:
        """Return stamp, in nanoseconds, and frame of a std_msgs/Header."""
        if self.ros1:
            self.u32()  # seq, which ROS 2 dropped
        return self.time_ns(), self.string().strip().lstrip("/")

    def sequence(self, read: Callable[[], T], smallest: int) -> list[T]:
        """Return a list of values.

        Args:
            read: reads one of them.
            smallest: fewest bytes of one.

        Raises:
            DriveError: the message has no room for so many.
        """
        count = self.u32()
        if count * smallest > len(self.data) - self.at:
            raise DriveError(
                f"{self.where}: a list of {count} values begins at byte {self.at}, but the message "
                f"has {len(self.data)} bytes. It is cut short, or of another type than its topic "
                "states"
            )
        return [read() for _ in range(count)]
