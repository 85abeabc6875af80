"""Smoke run of both clients on other Pythons, against a server of the standard library.

Prints `good` and the version of Python at the end. No pytest here: it is not installed there.
"""

import asyncio
import json
import sys
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

import numpy as np
import placecell_client
from placecell_client import AsyncClient, Client, CompactMap, ServiceError, decode, encode
from placecell_client.http.retry import Retries


class Handler(BaseHTTPRequestHandler):
    """Handler that answers `/describe` and refuses everything else."""

    def log_message(self, *_: Any) -> None:
        """Say nothing."""

    def do_POST(self) -> None:
        """Answer with a descriptor of each segment."""
        asked = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        item = {"codes": [1, 2], "descriptor": [0.5, 1.5], "centroid": [1.0, 2.0, 3.0]}
        answer = {"model_id": "m", "dimension": 2, "descriptors": [item] * len(asked["segments"])}
        self._answer(200, "application/json", answer)

    def do_GET(self) -> None:
        """Refuse, with a date to come again."""
        problem = {"type": "urn:p", "title": "Busy", "status": 503, "detail": "Later."}
        self._answer(503, "application/problem+json", problem)

    def _answer(self, status: int, kind: str, content: Any) -> None:
        body = json.dumps(content).encode()
        self.send_response(status)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(body)))
        self.send_header("Retry-After", "Fri, 31 Dec 1999 23:59:59 GMT")
        self.end_headers()
        self.wfile.write(body)


def main() -> None:
    """Call both clients as a robot does."""
    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    url = f"http://127.0.0.1:{server.server_address[1]}"
    cloud = np.zeros(20, [("x", "f4"), ("y", "f4"), ("z", "f4"), ("ring", "u2")])
    cloud["x"][3] = np.nan
    once = Retries(attempts=1)
    with Client(url, encoding="json", retries=once) as client:
        description = client.describe([cloud], [0.0, 0.0, 1.0])
        assert description.dropped_points == 1
        assert description.codes.tolist() == [[1, 2]]
        refused = None
        try:
            client.info()
        except ServiceError as error:
            refused = error
        assert refused is not None
        assert (refused.status, refused.retry_after) == (503, 0.0)

    async def asynchronous() -> None:
        async with AsyncClient(url, encoding="json", retries=once) as client:
            several = [client.describe([cloud], [0.0, 0.0, 1.0]) for _ in range(5)]
            assert all(each.dropped_points == 1 for each in await asyncio.gather(*several))

    asyncio.run(asynchronous())
    server.shutdown()
    server.server_close()
    compact_map = CompactMap(
        model_id="m",
        preprocessing="v1",
        frame="yard",
        codes=np.ones((1, 2), np.int8),
        centroids=np.ones((1, 3)),
        ids=np.array([7], np.uint32),
        robots=("r",),
        robot=np.zeros(1, np.uint16),
        frame_index=np.zeros(1, np.uint32),
        frame_times=np.zeros(1),
        frame_positions=np.zeros((1, 3)),
        frame_orientations=np.array([[0, 0, 0, 1]], np.float32),
    )
    assert decode(encode(compact_map)).ids.tolist() == [7]
    assert placecell_client.__all__
    print("good", sys.version.split()[0])


if __name__ == "__main__":
    main()
