"""Attacks with connections that take more than their share: A3, A5, A6, A7, A11, A27."""

import socket
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager, suppress

import msgpack  # type: ignore[import-untyped]
import numpy as np
from placecell_client import Delta, encode

from benchmarks.attack.stage import NONE, VICTIM_MAP, AttackCase, Stage, template_of
from benchmarks.attack.target import OWNER, READER, ROBOT, VICTIM, WRITER, Target
from benchmarks.attack.wire import (
    DELTA,
    JSON,
    MAP,
    MSGPACK,
    AttackRequest,
    AttackResponse,
    abandon,
    connect,
    exchange_bytes,
    head_of,
)
from benchmarks.synthetic_maps.random_maps import MapTemplate

PIECE = 1 << 14
SMALL_WINDOW = 1 << 12
"""Receive window of a slow reader, bytes that its kernel holds."""

UNREAD_MB = 150.0
"""Largest growth of the service's memory for answers that no client reads, MB."""


def slow_download(stage: Stage) -> None:
    """A3: downloads over slow links that keep reading."""
    count = stage.size(320_000, 320_000)  # 14.9 MB
    with stage.service(own=False) as target:
        template = template_of(target)
        file = _put_map(stage, target, template, "large", count)
        stage.note("bytes", len(file))
        # The kernel's buffers hide a slow link at first, so each reader is slow for a long time.
        slow = stage.size(45, 20)
        links: list[tuple[str, float, str]] = [
            ("map at 500 kB/s", 5e5, "/maps/large"),
            ("map at 100 kB/s", 1e5, "/maps/large"),
            ("version at 100 kB/s", 1e5, "/maps/large?version=1"),
            ("changes at 100 kB/s", 1e5, "/maps/large/changes?since=0&limit=100000"),
        ]
        answers: list[tuple[str, int, int, int]] = []

        def read(link: tuple[str, float, str]) -> None:
            name, rate, path = link
            answers.append((name, *_read_slowly(target, path, rate, slow)))

        with stage.victim(target), ThreadPoolExecutor(len(links)) as pool:
            list(pool.map(read, links))
        for name, status, stated, arrived in answers:
            stage.found.statuses[str(status)] += 1
            stage.expect(
                status == 200 and stated in {arrived, -1} and arrived > 0,
                f"{name}: {arrived} of {stated} bytes arrived (status {status}).",
            )


def reads_of_old_versions(stage: Stage) -> None:
    """A5: many reads of stored versions, read and abandoned, while the victim writes."""
    versions, reads = stage.size(40, 6), stage.size(300, 40)
    with stage.service(own=False) as target:
        template = template_of(target)
        _put_map(stage, target, template, "history", stage.size(100_000, 30_000))
        client = target.client(ROBOT)
        for number in range(versions):
            ids = np.arange(number * 100, number * 100 + 100, dtype=np.uint32) + 1
            client.edit_map("history", Delta(template.random_map(ROBOT, ids, stage.random), NONE))
        paths: dict[str, Callable[[int], str]] = {
            "versions": lambda number: f"/maps/history?version={number % versions + 1}",
            "list of versions": lambda _: "/maps/history/versions?limit=10000",
            "changes": lambda _: "/maps/history/changes?since=0&limit=100000",
            "changes since": lambda number: f"/maps/history/changes?since={number % versions + 1}",
            "map": lambda _: "/maps/history",
            "list of maps": lambda _: "/maps",
        }
        for name, path in paths.items():
            requests = [AttackRequest("GET", path(number), key=READER) for number in range(reads)]
            target.forget_peak()
            with stage.victim(target, reads=True):
                with ThreadPoolExecutor(64) as pool:
                    list(pool.map(lambda each: abandon(target, each), requests))
                answers = stage.ask_all(target, requests[: reads // 2], 64)
            _expect_refusals(stage, answers, name)


def trickled_bodies(stage: Stage) -> None:
    """A6: many requests whose bodies arrive one byte per second."""
    seconds = stage.size(15, 1)
    packed, delta, file = ({"Content-Type": each} for each in (MSGPACK, DELTA, MAP))
    doors = {
        "describe": [AttackRequest("POST", "/describe", key=ROBOT, headers=packed)] * 40
        + [AttackRequest("POST", "/localize", key=READER, headers=packed)] * 40,
        "edit": [AttackRequest("POST", "/maps/slow/segments?create=true", key=ROBOT, headers=delta)]
        * 40,
        "put": [AttackRequest("PUT", "/maps/slow", key=ROBOT, headers=file)] * 20,
        "merge": [
            AttackRequest("POST", "/maps/slow/merge", key=WRITER, headers={"Content-Type": JSON})
        ]
        * 20,
        "unexpected body": [AttackRequest("GET", "/maps", key=READER, headers=packed)] * 40,
    }
    with stage.service(own=False) as target:
        small = encode(
            template_of(target).random_map(VICTIM, np.arange(1, 9, dtype=np.uint32), stage.random)
        )
        align = AttackRequest("POST", f"/maps/{VICTIM_MAP}/align/{VICTIM_MAP}", key=VICTIM)
        with stage.victim(target):
            pass
        stage.ask(target, align)  # a warm-up: the first alignment compiles
        for name, requests in doors.items():
            with stage.victim(target), _trickling(target, requests):
                time.sleep(seconds)
                if name == "put":
                    _expect_at_once(
                        stage,
                        target,
                        AttackRequest("PUT", "/maps/small", small, VICTIM, file),
                        "An upload of 8 segments beside trickled uploads",
                    )
                if name == "merge":
                    _expect_at_once(stage, target, align, "An alignment beside trickled merges")


def unread_answers(stage: Stage) -> None:
    """A7: large answers that no client reads."""
    readers = stage.size(40, 30)
    with stage.service(own=False) as target:
        template = template_of(target)
        _put_map(stage, target, template, "large", stage.size(290_000, 100_000))
        codes = stage.random.integers(-127, 128, (1_000, template.code_bytes)).astype(np.int8)
        match = msgpack.packb({"model_id": template.model_id, "codes": codes.tobytes(), "k": 100})
        requests = {
            "map": AttackRequest("GET", "/maps/large", key=READER),
            "version": AttackRequest("GET", "/maps/large?version=1", key=READER),
            "changes": AttackRequest("GET", "/maps/large/changes?since=0&limit=100000", key=READER),
            "match": AttackRequest("POST", "/match", match, READER, {"Content-Type": MSGPACK}),
        }
        for name, request in requests.items():
            time.sleep(0.2)
            target.forget_peak()
            before = target.resident_mb()
            with stage.victim(target), ExitStack() as stack:
                for _ in range(readers):
                    with suppress(OSError):
                        link = stack.enter_context(connect(target, 10, SMALL_WINDOW))
                        link.sendall(head_of(target, request) + request.body)
                time.sleep(stage.size(10, 2))
            growth = target.peak_mb() - before
            stage.note(f"{name}, growth MB", round(growth))
            stage.expect(
                growth <= UNREAD_MB,
                f"{name}: {readers} answers that no client reads took {growth:.0f} MB; "
                f"{UNREAD_MB:.0f} are allowed.",
            )


def idle_connections(stage: Stage) -> None:
    """A11: more connections than the service accepts, silent or with half a request head."""
    count = 1_100
    with stage.service(own=False) as target:
        heads = {"silent": b"", "half a head": b"GET /livez HTTP/1.1\r\nHost: x\r\nX: "}
        if stage.short:
            del heads["half a head"]
        for name, head in heads.items():
            with stage.victim(target, writes=False), ExitStack() as stack:
                for _ in range(count):
                    with suppress(OSError):
                        stack.enter_context(connect(target, 5)).sendall(head)
                for path in ("/livez", "/readyz", "/metrics"):
                    answer = stage.ask(target, AttackRequest("GET", path), 10)
                    stage.expect(
                        answer.status == 200 and answer.seconds <= stage.victim_seconds,
                        f"{name}: beside {count} idle connections {path} was answered "
                        f"{answer.status} after {answer.seconds:.1f} s.",
                    )
                answer = _from_elsewhere(target, AttackRequest("GET", "/info", key=VICTIM))
                stage.count([answer])
                stage.expect(
                    answer.status == 200 and answer.seconds <= stage.victim_seconds,
                    f"{name}: a new connection from another address was answered {answer.status} "
                    f"after {answer.seconds:.1f} s.",
                )
            time.sleep(1)


def smuggled_requests(stage: Stage) -> None:
    """A27: requests that state their length twice and hide a second request in their body."""
    with stage.service(own=False) as target:
        template = template_of(target)
        _put_map(stage, target, template, "precious", 10)
        host = target.address.removeprefix("http://")
        key = "".join(f"{k}: {v}\r\n" for k, v in target.authorization(OWNER).items())
        hidden = f"DELETE /maps/precious HTTP/1.1\r\nHost: {host}\r\n{key}\r\n"
        chunked = f"0\r\n\r\n{hidden}"
        lengths = {
            "both": f"Transfer-Encoding: chunked\r\nContent-Length: {len(chunked)}\r\n",
            "length first": f"Content-Length: {len(chunked)}\r\nTransfer-Encoding: chunked\r\n",
            "length of zero": "Content-Length: 0\r\nTransfer-Encoding: chunked\r\n",
            "chunked twice": "Transfer-Encoding: chunked\r\nTransfer-Encoding: chunked\r\n",
            "other case": f"tRANSFER-eNCODING: Chunked\r\nContent-Length: {len(chunked)}\r\n",
            "unknown coding": f"Transfer-Encoding: xchunked\r\nContent-Length: {len(chunked)}\r\n",
            "space before colon": "Content-Length: 0\r\nTransfer-Encoding : chunked\r\n",
            "two lengths": f"Content-Length: 0\r\nContent-Length: {len(chunked)}\r\n",
            "signed length": "Content-Length: +0\r\n",
            "folded header": "X: a\r\n Transfer-Encoding: chunked\r\nContent-Length: 0\r\n\tx\r\n",
        }
        for name, headers in lengths.items():
            head = (
                f"POST /describe HTTP/1.1\r\nHost: {host}\r\nContent-Type: {JSON}\r\n{headers}\r\n"
            )
            answer = exchange_bytes(target, (head + chunked).encode(), 2)
            status = answer[9:12].decode(errors="replace")
            stage.found.statuses[status or "0"] += 1
            stage.expect(
                status in {"400", "501"} and not answer.endswith(b"(left open)"),
                f"{name}: the answer was {status or 'none'}"
                f"{', and the connection stayed open' if answer.endswith(b'open)') else ''}; "
                "400 and a closed connection were expected.",
            )
            there = stage.ask(target, AttackRequest("GET", "/maps/precious", key=OWNER))
            is_there = stage.expect(
                there.status == 200, f"{name}: the hidden DELETE was carried out."
            )
            if not is_there:
                _put_map(stage, target, template, "precious", 10)


def _put_map(stage: Stage, target: Target, template: MapTemplate, name: str, count: int) -> bytes:
    """Store a map of `count` segments and return its file."""
    file = encode(
        template.random_map(ROBOT, np.arange(1, count + 1, dtype=np.uint32), stage.random)
    )
    answer = stage.ask(
        target, AttackRequest("PUT", f"/maps/{name}", file, ROBOT, {"Content-Type": MAP})
    )
    stage.expect(answer.status == 201, f"A map of {count} segments was answered {answer.status}.")
    return file


def _read_slowly(target: Target, path: str, rate: float, slow: float) -> tuple[int, int, int]:
    """Read an answer slowly for `slow` seconds, then at full speed.

    Returns:
        The status, the stated length (-1: none), and the number of body bytes that arrived.
    """
    request = AttackRequest("GET", path, key=READER, headers={"Connection": "close"})
    with connect(target, 60, SMALL_WINDOW) as link:
        link.sendall(head_of(target, request))
        begun, received = time.perf_counter(), b""
        with suppress(OSError):
            while piece := link.recv(PIECE):
                received += piece
                due = begun + len(received) / rate
                now = time.perf_counter()
                if now < begun + slow:
                    time.sleep(max(0.0, due - now))
    head, _, body = received.partition(b"\r\n\r\n")
    lines = head.decode("latin-1").lower().split("\r\n")
    fields = dict(line.split(": ", 1) for line in lines[1:] if ": " in line)
    status = int(lines[0].split()[1]) if lines[0] else 0
    if "content-length" in fields:
        return status, int(fields["content-length"]), len(body)
    # A chunked answer is complete if its last, empty chunk has arrived.
    return status, -1, len(body) if body.endswith(b"0\r\n\r\n") else 0


@contextmanager
def _trickling(target: Target, requests: Sequence[AttackRequest]) -> Iterator[None]:
    """Send request heads, then one byte per second of each body until the block ends."""
    ended, links = threading.Event(), list[socket.socket]()

    def trickle() -> None:
        while not ended.wait(1):
            for number, request in enumerate(requests):
                if number >= len(links):
                    break
                try:
                    links[number].sendall(b"\x80")
                except OSError:  # refused: reconnect, as an attacker does
                    links[number].close()
                    with suppress(OSError):
                        links[number] = begin(request)

    def begin(request: AttackRequest) -> socket.socket:
        link = connect(target, 5)
        with suppress(OSError):
            link.sendall(head_of(target, request, 100_000) + b"\x81")
        return link

    for request in requests:
        links.append(begin(request))
    thread = threading.Thread(target=trickle)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()
        for link in links:
            link.close()


def _expect_at_once(stage: Stage, target: Target, request: AttackRequest, what: str) -> None:
    """Expect that the service answers another key's request at once."""
    begun = time.perf_counter()
    while (answer := stage.ask(target, request)).status in {0, 429, 503, 504}:
        if time.perf_counter() > begun + 5 * stage.victim_seconds:
            break
        time.sleep(0.1)
    waited = time.perf_counter() - begun
    stage.found.victim_max_s = max(stage.found.victim_max_s, round(waited, 3))
    stage.expect(
        waited <= stage.victim_seconds and answer.status not in {0, 429, 503, 504},
        f"{what} waited {waited:.1f} s and was answered {answer.status}.",
    )


def _from_elsewhere(target: Target, request: AttackRequest) -> AttackResponse:
    """Send a request from the victim's address."""
    host, port = target.place
    begun = time.perf_counter()
    try:
        with socket.create_connection((host, port), timeout=10) as link:
            link.sendall(head_of(target, request))
            line = link.recv(1 << 12).split()
        return AttackResponse(int(line[1]) if line else 0, time.perf_counter() - begun)
    except OSError:
        return AttackResponse(0, time.perf_counter() - begun)


def _expect_refusals(stage: Stage, answers: Sequence[AttackResponse], what: str) -> None:
    bad = sorted({answer.status for answer in answers} - {200, 304, 410, 429, 503, 504})
    stage.expect(not bad, f"{what}: answers had statuses {bad}.")
    slowest = max(answer.seconds for answer in answers)
    stage.note(f"{what}, slowest s", round(slowest, 2))
    stage.expect(slowest <= 30, f"{what}: a read took {slowest:.0f} s.")


CASES = (
    AttackCase(
        "A3",
        slow_download,
        "A download over a slow link arrives whole.",
        in_short=False,
    ),
    AttackCase("A5", reads_of_old_versions, "Reads of stored maps delay no client's writes."),
    AttackCase("A6", trickled_bodies, "A request takes a place only when its body is complete."),
    AttackCase("A7", unread_answers, "The bytes of answers in progress are bounded."),
    AttackCase(
        "A11", idle_connections, "Idle connections block neither health checks nor other clients."
    ),
    AttackCase(
        "A27",
        smuggled_requests,
        "A request that states its length twice gets a 400, and its connection is closed.",
    ),
)
