"""The bytes on the msgpack page equal those that the client sends and reads."""

import re
from pathlib import Path

import httpx
import msgpack  # type: ignore[import-untyped]
import numpy as np
from placecell_client import Client, ItemError
from placecell_client.http.encoding import segments_of

from placecell.descriptors.quantizer import LEVELS, Quantizer

DOCUMENT = Path(__file__).resolve().parents[2] / "docs" / "reference" / "msgpack.md"
LINE = r" {0,2}(\d+)  ([0-9a-f]{2}(?: [0-9a-f]{2})*)(?:  .*)?"
ORIGIN = [500000.0, 5400000.0, 300.0]
CLOUD = np.array([[4.0, 2.0, 0.5], [4.25, 2.0, 0.75]])


def example(name: str) -> bytes:
    """Return the bytes of a block; a line has an offset, bytes, two spaces and a comment."""
    text = DOCUMENT.read_text()
    block = re.search(rf"```{name}\n(.*?)```\n\n(\d+) bytes", text, re.DOTALL)
    assert block is not None
    data = b""
    for line in block[1].splitlines():
        parts = re.fullmatch(LINE, line)
        assert parts is not None, line
        assert int(parts[1]) == len(data), line
        data += bytes.fromhex(parts[2])
    assert len(data) == int(block[2])
    return data


def test_request_on_the_page_equals_the_clients_bytes() -> None:
    content = msgpack.unpackb(example("request"))
    assert content["segments"][0]["points"] == CLOUD.astype("<f4").tobytes()
    assert content == {
        "origin": ORIGIN,
        "segments": [{"points": CLOUD.astype("<f4").tobytes(), "sensor": [0.0, 0.0, 1.5]}],
    }
    sent, _ = segments_of([CLOUD.astype(np.float32)], [0.0, 0.0, 1.5], "msgpack")
    assert msgpack.packb({"origin": ORIGIN} | sent) == example("request")


def test_answer_on_the_page_is_read_by_the_client() -> None:
    def answer(_: httpx.Request) -> httpx.Response:
        headers = {"Content-Type": "application/msgpack"}
        return httpx.Response(200, content=example("answer"), headers=headers)

    with Client("http://service", transport=httpx.MockTransport(answer)) as client:
        described = client.describe([CLOUD, CLOUD], ORIGIN)
    assert described.model_id == "tiny-1"
    assert described.codes.tolist() == [[3, -7], [0, 0]]
    assert described.descriptors[0].tolist() == [0.0625, -0.125]
    assert described.centroids[0].tolist() == [500004.125, 5400002.0, 300.625]
    assert described.errors == {
        1: ItemError("urn:placecell:problem:too-few-points", "Too few points", "2 points.")
    }


def test_descriptor_is_at_the_documented_offset() -> None:
    text = DOCUMENT.read_text()
    told = re.search(r"(\d+) bytes at offset (\d+), behind its `(.{5})`", text)
    assert told is not None
    length, offset = int(told[1]), int(told[2])
    data = example("answer")
    assert data[offset - 2 : offset] == bytes.fromhex(told[3])
    assert np.frombuffer(data, "<f4", length // 4, offset).tolist() == [0.0625, -0.125]
    assert f"answer.data() + {offset}, {length})" in text


def test_levels_on_the_page_equal_the_quantizers() -> None:
    rows = re.findall(
        r"^\| (\d) \| (\d+) \| (.*) \| (-\d+) \|$", DOCUMENT.read_text(), re.MULTILINE
    )
    assert [int(row[0]) for row in rows] == sorted(LEVELS)
    for row in rows:
        per_byte, base, lowest = int(row[0]), int(row[1]), int(row[3])
        told = row[2].replace("..., ", "").split(", ")
        first, second, last = int(told[0]), int(told[1]), int(told[-1])
        levels = np.arange(first, last + 1, second - first)
        assert len(levels) == base
        numbers = np.arange(base**per_byte)
        digits = numbers[:, None] // base ** np.arange(per_byte) % base
        codes = (numbers + lowest).astype(np.int8)[:, None]
        np.testing.assert_array_equal(Quantizer(1.0, per_byte).levels(codes), levels[digits])


def test_example_byte_on_the_page_equals_the_quantizers() -> None:
    told = re.search(r"four in a byte, `(..)` is .*: levels (.*)\.", DOCUMENT.read_text())
    assert told is not None
    code = np.frombuffer(bytes.fromhex(told[1]), np.int8)[None]
    assert Quantizer(1.0, 4).levels(code).tolist() == [[int(level) for level in told[2].split(",")]]
