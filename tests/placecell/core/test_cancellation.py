"""Cancellation of Python code and compiled loops."""

import threading
import time
from typing import Any

import numba
import numpy as np
import pytest

from placecell.core.cancellation import Cancelled, CancelToken, cancelled_by, current, is_cancelled
from placecell.core.types import Int32, Int64


@numba.njit(nogil=True)  # type: ignore[misc, unused-ignore]
def _spin(flag: Int32, begun: Int64) -> None:
    """Loop until cancelled; the compiler cannot know that the flag changes."""
    rounds = 0
    while not is_cancelled(flag):
        rounds += 1
        begun[0] = rounds


def test_compiled_loop_ends_when_cancelled() -> None:
    token, begun = CancelToken(), np.zeros(1, np.int64)
    thread = threading.Thread(target=_spin, args=(token.flag, begun), daemon=True)
    thread.start()
    while not begun[0]:
        time.sleep(0.001)
    assert thread.is_alive()
    token.cancel()
    thread.join(60)
    assert not thread.is_alive()


def test_check_raises_after_cancellation() -> None:
    token = CancelToken()
    token.check()
    token.cancel()
    with pytest.raises(Cancelled):
        token.check()


def test_deadline_in_the_past_cancels() -> None:
    token = CancelToken(time.monotonic() - 1.0)
    assert not token.flag[0]
    assert token.is_cancelled
    assert token.flag[0]
    assert token.seconds_left == 0.0


def test_current_token_is_that_of_the_block() -> None:
    outside = current()
    outside.cancel()  # is nobody's
    assert not current().is_cancelled
    with cancelled_by(CancelToken()) as outer:
        assert current() is outer
        with cancelled_by(CancelToken()) as inner:
            assert current() is inner
        assert current() is outer
    assert current() is not outer


def test_current_token_reaches_worker_threads() -> None:
    import anyio
    import anyio.to_thread

    async def run() -> Any:
        with cancelled_by(CancelToken()) as token:
            return token, await anyio.to_thread.run_sync(current)

    token, seen = anyio.run(run)
    assert seen is token
