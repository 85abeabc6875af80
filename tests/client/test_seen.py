"""Versions that a client has seen go with its requests, for services that share a database."""

import asyncio

import httpx
from placecell_client.seen import GONE, MOST, SEEN_HEADER, SeenVersions

from service.maps.following.follower import seen_versions
from tests.client.client_fakes import async_client_of, client_of

TAG = "0123456789abcdef-{}"


def noted(*answers: tuple[str, str, str | None]) -> dict[str, str]:
    """Return what a client knows after answers with a method, a path and an ETag."""
    seen = SeenVersions()
    for method, path, etag in answers:
        seen.note(method, path, {} if etag is None else {"ETag": etag})
    header = seen.headers()
    assert {*header} <= {SEEN_HEADER}
    return dict(seen_versions(header.get(SEEN_HEADER, "")))


def quoted(number: int) -> str:
    return f'"{TAG.format(number)}"'


def test_versions_of_own_writes_and_reads_are_known() -> None:
    assert noted() == {}
    known = noted(
        ("PUT", "/maps/yard", quoted(1)),
        ("POST", "/maps/yard/segments?create=true", quoted(2)),
        ("GET", "/maps/hall", f"W/{quoted(7)}"),
        ("GET", "/maps/shed/changes?since=0", quoted(3)),
        ("PUT", "/maps/yard/tags", None),
        ("DELETE", "/maps/barn", None),
        ("DELETE", "/maps/yard/anchor", None),
        ("POST", "/match", quoted(9)),
    )
    assert known == {
        "yard": TAG.format(2),
        "hall": TAG.format(7),
        "shed": TAG.format(3),
        "barn": GONE,
    }


def test_earlier_versions_say_nothing_about_the_newest() -> None:
    write = ("PUT", "/maps/yard", quoted(5))
    for path in ("/maps/yard?version=2", "/maps/yard/versions/2/changes", "/maps/yard"):
        assert noted(write, ("GET", path, quoted(2))) == {"yard": TAG.format(5)}
    assert noted(write, ("PUT", "/maps/yard", quoted(1))) == {"yard": TAG.format(1)}
    gone = ("DELETE", "/maps/yard", None)
    assert noted(write, gone, ("GET", "/maps/yard", quoted(1))) == {"yard": TAG.format(1)}
    assert noted(("GET", "/maps/yard", '"other"')) == {}


def test_header_names_the_maps_that_were_used_last() -> None:
    numbers = range(MOST + 4)
    known = noted(*(("GET", f"/maps/m{number}", quoted(1)) for number in (*numbers, 5)))
    assert len(known) == MOST
    assert "m5" in known
    assert "m3" not in known


def test_both_clients_send_what_they_have_seen() -> None:
    sent: list[str | None] = []

    def answer(request: httpx.Request) -> httpx.Response:
        sent.append(request.headers.get(SEEN_HEADER))
        if request.method == "DELETE":
            return httpx.Response(204)
        return httpx.Response(404 if request.url.path == "/maps/none" else 200, json={})

    with client_of(answer) as client:
        client.delete_map("yard")
        client.delete_map("hall")
        client.delete_map("yard")
    assert sent == [None, f"yard {GONE}", f"yard {GONE}, hall {GONE}"]
    sent.clear()

    async def deleted() -> None:
        async with async_client_of(answer) as client:
            await client.delete_map("yard")
            await client.delete_map("hall")

    asyncio.run(deleted())
    assert sent == [None, f"yard {GONE}"]
