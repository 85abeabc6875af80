"""The bytes in MSGPACK.md are those that the client sends and reads."""

import re
from pathlib import Path

import httpx
import msgpack  # type: ignore[import-untyped]
import numpy as np
from placecell_client import Client, ItemError
from placecell_client.wire import segments_of

DOCUMENT = Path(__file__).resolve().parents[2] / "client" / "MSGPACK.md"
HEX = r"([0-9a-f]{2}(?: [0-9a-f]{2})*)(?:  .*)?"
ORIGIN = [500000.0, 5400000.0, 300.0]
CLOUD = np.array([[4.0, 2.0, 0.5], [4.25, 2.0, 0.75]])


def example(name: str) -> bytes:
    """The bytes of a block; its comments stand two spaces behind."""
    text = DOCUMENT.read_text()
    block = re.search(rf"```{name}\n(.*?)```\n\n(\d+) bytes", text, re.DOTALL)
    assert block is not None
    lines = [re.fullmatch(HEX, line) for line in block[1].splitlines()]
    data = b"".join(bytes.fromhex(line[1]) for line in lines if line is not None)
    assert None not in lines
    assert len(data) == int(block[2])
    return data


def test_the_request_is_the_clients() -> None:
    content = msgpack.unpackb(example("request"))
    assert content["segments"][0]["points"] == CLOUD.astype("<f4").tobytes()
    assert content == {
        "origin": ORIGIN,
        "segments": [{"points": CLOUD.astype("<f4").tobytes(), "sensor": [0.0, 0.0, 1.5]}],
    }
    sent = segments_of([CLOUD.astype(np.float32)], [0.0, 0.0, 1.5], "msgpack")
    assert msgpack.packb({"origin": ORIGIN} | sent) == example("request")


def test_the_answer_is_read_by_the_client() -> None:
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
