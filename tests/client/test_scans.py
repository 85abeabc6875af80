"""Point cloud files and exports: requests, and answers that are none."""

import httpx
import numpy as np
import pytest
from placecell_client import ServiceError

from tests.client.client_fakes import WRITTEN, client_of


def test_scan_is_not_added_twice_after_a_lost_answer() -> None:
    asked: list[str] = []

    def lost(request: httpx.Request) -> httpx.Response:
        asked.append(request.url.path)
        raise httpx.ReadTimeout("lost")

    with client_of(lost) as client:
        with pytest.raises(httpx.TransportError):
            client.add_scan("yard", b"scan", robot="ann")
        assert len(asked) == 1
        with pytest.raises(httpx.TransportError):
            client.add_scan("yard", b"scan", robot="ann", if_match="e-3")
        assert len(asked) > 2


def test_request_names_the_file_and_the_pose() -> None:
    seen: list[httpx.Request] = []

    def answer(request: httpx.Request) -> httpx.Response:
        seen.append(request)
        return httpx.Response(200, json=WRITTEN | {"ids": [], "unusable": 0, "problems": []})

    with client_of(answer) as client:
        client.add_scan(
            "yard",
            b"scan",
            position=np.array([1.5, -2, 0]),
            yaw=0.25,
            time=3.5,
            file_name="b.las",
        )
        query = dict(seen[0].url.params)
        assert query == {
            "name": "b.las", "x": "1.5", "y": "-2.0", "z": "0.0", "yaw": "0.25", "time": "3.5",
        }  # fmt: skip
        assert seen[0].content == b"scan"
        for wrong in ([1, 2], [[1, 2, 3]], ["a", "b", "c"]):
            with pytest.raises(ValueError, match="position"):
                client.add_scan("yard", b"scan", position=wrong)
        with pytest.raises(FileNotFoundError):
            client.scan_file("missing.pcd")


def test_login_page_is_no_export() -> None:
    page = httpx.Response(200, html="<form>")
    with client_of(lambda _: page) as client, pytest.raises(ServiceError):
        client.export("yard", "ply")
