"""Receiving of request bodies, with limits on media type, progress and memory."""

import time
from collections import Counter
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import anyio
from fastapi import Request

from service.api.body.compression import CODINGS
from service.core.problems import Problem

RETRY_SECONDS = 1

SLOWEST_RATE = 1_000
"""Lowest average rate of a body after its first `stall_seconds`, bytes/s."""


@dataclass(frozen=True, slots=True)
class BodyRules:
    """Time limits of a body.

    Attributes:
        seconds: longest time until the body has arrived, seconds.
        stall_seconds: longest time without a new byte, seconds.
    """

    seconds: float
    stall_seconds: float


class ByteBudget:
    """Budget of bytes that clients may hold at once, in total and per client."""

    def __init__(self, total: int, share: int, what: str) -> None:
        """Create a budget.

        Args:
            total: budget of all clients together, bytes.
            share: budget of one client, bytes.
            what: kind of content that the bytes hold, named in errors.
        """
        self.total = total
        self.share = share
        self._what = what
        self._held: Counter[str] = Counter()
        self.bytes = 0

    def take(self, client: str, count: int) -> None:
        """Count bytes of a client.

        Raises:
            Problem: 429 if the bytes exceed the budget.
        """
        if self._held[client] + count > self.share:
            raise busy(
                f"This client has {self._held[client]} bytes of {self._what} in progress; "
                f"the limit is {self.share}."
            )
        if self.bytes + count > self.total:
            raise busy(
                f"{self.bytes} bytes of {self._what} are in progress; the limit is {self.total}."
            )
        self._held[client] += count
        self.bytes += count

    def has_room(self, client: str, count: int) -> bool:
        """Return whether the budget has that many bytes left for a client."""
        return self._held[client] + count <= self.share and self.bytes + count <= self.total

    def give_back(self, client: str, count: int) -> None:
        """Stop counting bytes of a client."""
        self.bytes -= count
        self._held[client] -= count
        if not self._held[client]:
            del self._held[client]


class Held:
    """Bytes of a budget that one request holds."""

    def __init__(self, budget: ByteBudget, client: str) -> None:
        self._budget = budget
        self._client = client
        self._bytes = 0

    def add(self, count: int) -> None:
        """Hold more bytes.

        Raises:
            Problem: 429 if the bytes exceed the budget.
        """
        self._budget.take(self._client, count)
        self._bytes += count

    def release(self) -> None:
        """Return all held bytes to the budget."""
        self._budget.give_back(self._client, self._bytes)
        self._bytes = 0


class Receiver:
    """Receiver of bodies that limits their number and bytes per client."""

    def __init__(self, bodies: int, budget: ByteBudget) -> None:
        """Create a receiver.

        Args:
            bodies: largest number of bodies that one client sends at once.
            budget: budget of the bytes of all bodies.
        """
        self._bodies = bodies
        self._budget = budget
        self._receiving: Counter[str] = Counter()

    @contextmanager
    def holding(self, client: str) -> Iterator[Held]:
        """Count the bytes of a request's body for a block."""
        held = Held(self._budget, client)
        try:
            yield held
        finally:
            held.release()

    async def receive(self, request: Request, client: str, rules: BodyRules, held: Held) -> bytes:
        """Receive a body and return its bytes, without decoding.

        Raises:
            Problem: 408 if the body does not arrive in time, 429 if the client sends too many
                bodies or bytes at once.
        """
        if self._receiving[client] >= self._bodies:
            raise busy(
                f"This client already sends {self._receiving[client]} bodies; the limit is "
                f"{self._bodies}.",
                closes=True,
            )
        self._receiving[client] += 1
        try:
            return await _receive(request, rules, held)
        finally:
            self._receiving[client] -= 1
            if not self._receiving[client]:
                del self._receiving[client]


async def _receive(request: Request, rules: BodyRules, held: Held) -> bytes:
    parts: list[bytes] = []
    received = 0
    began = time.monotonic()
    stream = request.stream()
    while True:
        spent = time.monotonic() - began
        patience = min(rules.seconds - spent, rules.stall_seconds)
        part = None
        with anyio.move_on_after(patience):
            part = await anext(stream, b"")
            if not part:
                return b"".join(parts)
        if part is None:
            raise _slow(rules, spent + patience, received)
        received += len(part)
        late = time.monotonic() - began - rules.stall_seconds
        if received < SLOWEST_RATE * late:
            raise _slow(rules, late + rules.stall_seconds, received)
        try:
            held.add(len(part))
        except Problem as problem:
            problem.headers = {**(problem.headers or {}), "Connection": "close"}
            raise
        parts.append(part)


def _slow(rules: BodyRules, spent: float, received: int) -> Problem:
    if spent >= rules.seconds:
        why = f"The body did not arrive within {rules.seconds:g} s."
    else:
        why = (
            f"The body arrived too slowly: {received} bytes in {spent:.3g} s. Send it without "
            f"pauses of {rules.stall_seconds:g} s."
        )
    return Problem(408, "slow-body", why, headers={"Connection": "close"})


def check_types(request: Request, media_types: Collection[str]) -> tuple[str, str]:
    """Return the body's media type and content coding; empty strings for missing headers.

    Raises:
        Problem: 415 if the type or the coding is not supported.
    """
    stated = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if stated and stated not in media_types:
        raise Problem(
            415,
            "unsupported-media-type",
            f"Invalid Content-Type {stated!r:.80}: expected {' or '.join(sorted(media_types))}."
            + form_hint(stated, media_types),
            headers={"Accept": ", ".join(sorted(media_types))},
        )
    coding = request.headers.get("content-encoding", "identity").strip().lower()
    if coding not in {"identity", *CODINGS}:
        raise Problem(
            415,
            "unsupported-content-encoding",
            f"Invalid Content-Encoding {coding!r:.80}: expected {' or '.join(CODINGS)}.",
            headers={"Accept-Encoding": ", ".join(CODINGS)},
        )
    return stated, coding


def busy(detail: str, closes: bool = False) -> Problem:
    """Return the problem of a client that exceeds a limit on concurrent work."""
    headers = {"Retry-After": str(RETRY_SECONDS)}
    if closes:
        headers["Connection"] = "close"
    return Problem(429, "busy", f"{detail} Try again in {RETRY_SECONDS} s.", headers=headers)


def form_hint(stated: str, media_types: Collection[str]) -> str:
    """Return a hint about Content-Type if a program labeled the body a form, as curl does."""
    if stated != "application/x-www-form-urlencoded":
        return ""
    wanted = min(media_types)
    return f" curl labels every body a form: add -H 'Content-Type: {wanted}'."
