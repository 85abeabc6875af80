"""`placecell maps mirror`: a copy of another service's map that survives interruptions."""

import json
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest
from placecell_client import Client, MapCopy, Retries, ServiceError

from cli.maps import mirroring
from cli.maps.mirroring import Mirror, PageSpool
from placecell.descriptors.manifest import Manifest
from tests.cli.maps_command import bad, good
from tests.service.conftest import data_dir, manifest, models_dir, start  # noqa: F401
from tests.service.service_builders import edit_of, map_of, random_codes

SOURCE = "http://hq/maps/yard"
DOCK = (1.0, 2.0, 0.5)


class CutTransport(httpx.BaseTransport):
    """Link to a service that is cut after some requests."""

    def __init__(self, inner: httpx.BaseTransport) -> None:
        self.inner = inner
        self.left = 10**9
        self.paths: list[str] = []

    def handle_request(self, request: httpx.Request) -> httpx.Response:
        """Pass a request on, or fail as a cut link does."""
        if self.left <= 0:
            raise httpx.ConnectError("the link is cut")
        self.left -= 1
        self.paths.append(f"{request.method} {request.url.raw_path.decode()}")
        return self.inner.handle_request(request)


class Site:
    """A remote and a local service in this process, and mirrors between them."""

    def __init__(self, remote: Any, local: Any, spool: Path) -> None:
        self.link = CutTransport(remote._transport)
        self.inside = CutTransport(local._transport)
        once = Retries(attempts=1)
        self.remote = Client("http://hq", transport=remote._transport, retries=once)
        self.far = Client("http://hq", transport=self.link, retries=once)
        self.near = Client("http://here", transport=self.inside, retries=once, mirrors=SOURCE)
        self.local = Client("http://here", transport=local._transport, retries=once)
        self.spool = spool

    def mirror(self, target: str = "copy") -> Mirror:
        """Return a mirror that has just been started."""
        return Mirror(self.far, self.near, "yard", target, SOURCE, self.spool)

    def is_same(self, target: str = "copy") -> bool:
        """Return whether the copy has the remote map's bytes."""
        return self.remote.get_map_file("yard") == self.local.get_map_file(target)


@pytest.fixture
def site(start: Callable[..., Any], tmp_path: Path) -> Iterator[Site]:  # noqa: F811
    with start(data_dir=tmp_path / "far") as remote, start(data_dir=tmp_path / "near") as local:
        yield Site(remote, local, tmp_path / "spool")


@pytest.fixture(autouse=True)
def small_pages(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = Client.changes
    monkeypatch.setattr(
        Client,
        "changes",
        lambda self, name, since, cursor, moved: whole(self, name, since, cursor, 10, moved=moved),
    )


@pytest.fixture
def yard(site: Site, manifest: Manifest) -> Callable[..., None]:  # noqa: F811
    """Store a map of 45 segments; the function edits it."""
    site.remote.put_map("yard", map_of(random_codes(45), manifest.model_id))

    def edit(first: int = 200, count: int = 3, removed: tuple[int, ...] = ()) -> None:
        from placecell_client import decode_delta

        codes = random_codes(count, seed=first)
        site.remote.edit_map(
            "yard", decode_delta(edit_of(codes, manifest.model_id, first, removed=removed))
        )

    return edit


def test_mirror_has_the_same_bytes_and_transfers_only_changes(
    site: Site, yard: Callable[..., None]
) -> None:
    site.remote.set_tags("yard", ["outdoor"])
    site.remote.set_anchor("yard", 49.0, 8.4, height=115.0, yaw_deg=37.0)
    site.remote.set_named_anchor("yard", "dock", DOCK)
    mirror = site.mirror()
    done = mirror.step()
    assert (done.segments, done.is_new, done.etag) == (45, True, site.remote.maps().maps[0].etag)
    assert site.is_same()
    assert site.local.tags("copy") == ("outdoor",)
    assert site.local.anchor("copy").lat == 49.0
    assert site.local.named_anchor("copy", "dock").position.tolist() == [*DOCK]
    yard(removed=(100, 101))
    site.remote.delete_anchor("yard")
    site.remote.delete_named_anchor("yard", "dock")
    site.link.paths.clear()
    assert mirror.step().segments == 46
    changes = [path for path in site.link.paths if "/changes" in path]
    assert len(changes) == 1
    assert site.is_same()
    assert site.local.anchors("copy") == ()
    with pytest.raises(ServiceError, match="no WGS 84 anchor"):
        site.local.anchor("copy")
    assert not mirror.step().is_new
    with pytest.raises(ServiceError, match=f"read-only mirror of {SOURCE}"):
        site.local.set_tags("copy", [])


def test_running_mirror_sends_only_changes_to_the_local_service(
    site: Site, yard: Callable[..., None]
) -> None:
    mirror = site.mirror()
    mirror.step()
    whole, part = "PUT /maps/copy", "POST /maps/copy/segments"
    for first in (200, 300):
        yard(first=first, removed=(first // 2, first // 2 + 1))
        site.inside.paths.clear()
        assert mirror.step().is_new
        assert (whole in site.inside.paths, part in site.inside.paths) == (False, True)
        assert site.is_same()
    # Another copier of the same source wrote meanwhile.
    yard(first=400)
    site.mirror().step()
    yard(first=500)
    site.inside.paths.clear()
    mirror.step()
    assert site.inside.paths.index(part) < site.inside.paths.index(whole)
    assert site.is_same()


def test_cut_and_restarted_mirror_goes_on_with_the_missing_page(
    site: Site, yard: Callable[..., None]
) -> None:
    site.link.left = 3
    with pytest.raises(httpx.ConnectError, match="the link is cut"):
        site.mirror().step()
    site.link.left, received = 10**9, len(site.link.paths)
    assert received == 3
    # Another process begins where this one was.
    assert site.mirror().step().segments == 45
    pages = [path for path in site.link.paths if "/changes" in path]
    assert len(pages) == 5 + 1  # the last asks whether there is a newer version
    assert site.is_same()
    assert not list(site.spool.rglob("*.page"))


@pytest.mark.slow
@pytest.mark.parametrize("steps", [1, 3, 4, 6])
def test_mirror_that_is_cut_from_the_local_service_recovers(
    site: Site, yard: Callable[..., None], steps: int
) -> None:
    site.inside.left = steps
    try:
        site.mirror().step()
    except httpx.ConnectError:
        yard()
    site.inside.left = 10**9
    mirror = site.mirror()
    mirror.step()
    assert site.is_same()
    for again in (site.mirror(), mirror):
        yard(first=300 + 9 * steps, removed=(102,))
        site.inside.left = steps
        try:
            mirror.step()
        except httpx.ConnectError:
            yard(first=400 + 9 * steps, removed=(103, 104))
        site.inside.left = 10**9
        again.step()
        assert site.is_same()


def test_compacted_or_recreated_remote_map_is_copied_as_a_whole(
    site: Site,
    yard: Callable[..., None],
    manifest: Manifest,  # noqa: F811
) -> None:
    mirror = site.mirror()
    mirror.step()
    for first in (200, 220, 240):
        yard(first=first)
    site.remote.compact_map("yard", keep=1)
    mirror.step()
    assert site.is_same()
    site.remote.delete_map("yard")
    with pytest.raises(ServiceError, match="404"):
        mirror.step()
    site.remote.put_map("yard", map_of(random_codes(12, seed=9), manifest.model_id))
    assert mirror.step().segments == 12
    assert site.is_same()


def test_map_with_other_columns_is_mirrored(
    site: Site,
    yard: Callable[..., None],
    manifest: Manifest,  # noqa: F811
) -> None:
    mirror = site.mirror()
    plain = map_of(random_codes(4), manifest.model_id)
    count = len(plain.frame_times)
    odometry = replace(
        plain, frame_tracks=np.ones(count, np.uint32), frame_odometry=np.zeros((count, 7))
    )
    for content in (plain, odometry, plain):
        site.remote.put_map("yard", content, if_match="*")
        assert mirror.step().is_new
        assert site.is_same()


def test_maps_of_this_service_and_other_mirrors_are_not_touched(
    site: Site,
    yard: Callable[..., None],
    manifest: Manifest,  # noqa: F811
) -> None:
    mine = map_of(random_codes(5), manifest.model_id)
    site.local.put_map("copy", mine)
    with pytest.raises(ServiceError, match="5 segments and is no mirror"):
        site.mirror().step()
    np.testing.assert_array_equal(site.local.get_map("copy").ids, mine.ids)
    empty = map_of(random_codes(0), manifest.model_id)
    site.local.put_map("other", empty)
    site.local.set_mirror("other", "http://elsewhere/maps/yard")
    with pytest.raises(ValueError, match="is a mirror of http://elsewhere/maps/yard"):
        site.mirror("other").step()


def test_damaged_pages_are_dropped(site: Site, yard: Callable[..., None]) -> None:
    for wrong in (b"", b"{}\n", b'{"since": "0", "cursor": null, "etag": "", "next": "x"}\nx'):
        site.link.left = 2
        with pytest.raises(httpx.ConnectError):
            site.mirror().step()
        first, *_ = sorted(site.spool.rglob("*.page"))
        first.write_bytes(wrong)
        site.link.left = 10**9
        copy = MapCopy("yard")
        PageSpool(first.parent).load(copy)
        assert copy.request == ("0", None)
        assert not first.exists()
    assert site.mirror().step().segments == 45


class TestCommand:
    """The command, with both clients replaced."""

    @pytest.fixture(autouse=True)
    def clients(
        self, site: Site, yard: Callable[..., None], monkeypatch: pytest.MonkeyPatch
    ) -> dict[str, Any]:
        import placecell_client

        given: dict[str, Any] = {}

        def client(address: str, timeout: float, **options: Any) -> Client:
            address = address.rstrip("/")
            given[address] = options
            link = site.link if address == "http://hq" else site.inside
            return Client(
                address, timeout, transport=link, retries=Retries(attempts=1),
                mirrors=options.get("mirrors"),
            )  # fmt: skip

        monkeypatch.setattr(placecell_client, "Client", client)
        monkeypatch.setattr(mirroring, "Client", client)
        monkeypatch.setenv("PLACECELL_CACHE", str(site.spool))
        return given

    def test_once_copies_and_end_ends(
        self, site: Site, clients: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setenv("PLACECELL_REMOTE_KEY", "from-the-environment")
        assert "45 segments" in good("mirror", "http://hq/", "yard", "--as", "copy", "--once")
        told = json.loads(good("mirror", "http://hq", "yard", "--as", "copy", "--once", "--json"))
        assert told["changed"] is False
        assert told["source"] == SOURCE
        assert clients["http://hq"]["key"] == "from-the-environment"
        (tmp_path / "key").write_text("from-the-file\n")
        words = ("mirror", "http://hq", "yard", "--as", "copy")
        good(*words, "--once", "--key-file", tmp_path / "key")
        assert clients["http://hq"]["key"] == "from-the-file"
        assert "takes writes again" in good(*words, "--end")
        assert site.local.set_tags("copy", ["mine"]) == ("mine",)

    def test_cut_link_is_tried_again(
        self, site: Site, monkeypatch: pytest.MonkeyPatch, yard: Callable[..., None]
    ) -> None:
        waits: list[float] = []

        def sleep(seconds: float) -> None:
            waits.append(seconds)
            if len(waits) == 2:
                raise KeyboardInterrupt
            site.link.left = 10**9

        monkeypatch.setattr(time, "sleep", sleep)
        site.link.left = 2
        words = ("mirror", "http://hq", "yard", "--as", "copy", "--every", "5")
        from tests.cli.maps_command import run

        result = run(*words)
        assert result.exit_code == 130
        assert "the link is cut" in result.output
        assert "The next try is in 5 s" in result.output
        assert waits == [5.0, 5.0]
        assert site.is_same()

    def test_errors_end_the_command(self, site: Site) -> None:
        told = bad("mirror", "http://ann:secret@hq", "yard", "--once")
        assert "without user and password" in told
        assert "secret" not in told
        assert "No map is named" in bad("mirror", "http://hq", "hall", "--once")
        site.link.left = 0
        assert "the link is cut" in bad("mirror", "http://hq", "yard", "--once")
