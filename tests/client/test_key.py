"""The API key is sent to the service and appears nowhere else."""

import traceback
from typing import Any

import httpx
import pytest
from placecell_client import AsyncClient, Client, ServiceError

from tests.client.client_fakes import INFO, Blocking, client_of

KEY = "s3cret-Key~1.2_3+/='"


@pytest.mark.parametrize("make", [client_of, Blocking])
def test_every_attempt_carries_the_key(make: Any) -> None:
    seen: list[str | None] = []

    def answer(request: httpx.Request) -> httpx.Response:
        seen.append(request.headers.get("Authorization"))
        return httpx.Response(200, json=INFO) if len(seen) > 1 else httpx.Response(503)

    make(answer, key=KEY).info()
    assert seen == [f"Bearer {KEY}"] * 2
    make(answer).info()
    assert seen[2] is None


@pytest.mark.parametrize("kind", [Client, AsyncClient])
def test_repr_shows_only_the_address(kind: type[Client | AsyncClient]) -> None:
    client = kind("http://robot:password@service/base", key=KEY)
    assert repr(client) == f"{kind.__name__}(URL('http://robot:[secure]@service/base/'))".replace(
        "base/", "base"
    )
    for value in vars(client).values():
        assert KEY not in repr(value)
    assert KEY not in repr(vars(client._http))


@pytest.mark.parametrize(
    "response",
    [
        httpx.Response(401, json={"title": KEY, "detail": f"no such key: {KEY}", "type": KEY}),
        httpx.Response(403, text=f"Authorization: Bearer {KEY}"),
        httpx.Response(200, text=f"Authorization: Bearer {KEY}"),
        httpx.Response(200, text=" " * 5000 + "." * 90 + KEY),
        httpx.Response(200, json={"model": {"model_id": ""}, "version": "", "limits": KEY}),
    ],
)
@pytest.mark.parametrize("make", [client_of, Blocking])
def test_service_errors_hide_the_key(make: Any, response: httpx.Response) -> None:
    with pytest.raises(ServiceError) as raised:
        make(lambda _: response, key=KEY).info()
    assert "s3cret" not in "".join(traceback.format_exception(raised.value))
    assert "s3cret" not in repr(vars(raised.value))
    assert "[key]" in raised.value.detail


def test_transport_errors_hide_the_key() -> None:
    def answer(request: httpx.Request) -> httpx.Response:
        raise httpx.ConnectError("refused", request=request)

    with client_of(answer, key=KEY) as client, pytest.raises(httpx.ConnectError) as raised:
        client.info()
    assert KEY not in "".join(traceback.format_exception(raised.value))
    assert KEY not in repr(raised.value.request.headers)


@pytest.mark.parametrize(
    "key", ["", "two words", "line's end\n", 'quo"te', "back\\slash", "schlüssel", "\x00"]
)
@pytest.mark.parametrize("kind", [Client, AsyncClient])
def test_invalid_key_is_refused_without_showing_it(
    kind: type[Client | AsyncClient], key: str
) -> None:
    with pytest.raises(ValueError, match="Invalid key: expected one or more visible") as raised:
        kind("http://service", key=key)
    assert not key or key not in str(raised.value)
