"""Admission control: overload, deadlines, disconnects, slow bodies; metrics of requests."""

import asyncio
import threading
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from typing import Any

import httpx
import numpy as np
import pytest

from placecell.descriptors.extractor import EigenvalueExtractor, Inputs
from service.api.state import open_state
from service.app import create_app
from service.core.settings import Settings
from tests.service.service_builders import (
    ask_app,
    assert_problem,
    cloud,
    map_of,
    random_codes,
    request_of,
)


@contextmanager
def held(monkeypatch: pytest.MonkeyPatch) -> Iterator[threading.Event]:
    """Block the model's inference; the event is set once inference has begun."""
    begun, released = threading.Event(), threading.Event()

    def slow(_: object, inputs: Inputs) -> Any:
        begun.set()
        assert released.wait(60)
        return np.zeros((len(inputs["features"]), 7), np.float32)

    monkeypatch.setattr(EigenvalueExtractor, "infer", slow)
    try:
        yield begun
    finally:
        released.set()


def value(service: Any, name: str) -> float:
    """Return a metric's value, with its labels as part of the name."""
    lines = service.get("/metrics").text.splitlines()
    return next((float(line.split()[-1]) for line in lines if line.startswith(name + " ")), 0.0)


def test_full_lane_answers_429_at_once(start: Any, monkeypatch: Any) -> None:
    body = request_of([cloud(0)])
    with start(limits={"requests": 2}) as service, ThreadPoolExecutor(2) as pool:
        with held(monkeypatch) as begun:
            pending = [pool.submit(service.post, "/describe", json=body) for _ in range(2)]
            assert begun.wait(60)
            while value(service, "placecell_queue_requests") < 2:
                time.sleep(0.01)
            refused = service.post("/match", json=body)
            assert_problem(refused, 429, "busy", "Try again")
            assert int(refused.headers["retry-after"]) >= 1
            # Health is never throttled.
            assert service.get("/livez").status_code == 200
        assert [each.result(60).status_code for each in pending] == [200, 200]
        assert service.post("/describe", json=body).status_code == 200
        assert value(service, "placecell_queue_requests") == 0
        assert value(service, 'placecell_rejected_total{reason="busy"}') == 1


def test_request_past_its_deadline_answers_504(service: Any, monkeypatch: Any) -> None:
    body = request_of([cloud(0)])
    timeout = {"Placecell-Timeout": "0.2"}
    with held(monkeypatch):
        response = service.post("/describe", json=body, headers=timeout)
        assert_problem(response, 504, "deadline-exceeded", "0.2 s")
    assert service.post("/describe", json=body, headers=timeout).status_code == 200


@pytest.mark.parametrize("given", ["0", "-1", "nan", "soon", ""])
def test_invalid_deadline_answers_422(service: Any, given: str) -> None:
    response = service.post(
        "/describe", json=request_of([cloud(0)]), headers={"Placecell-Timeout": given}
    )
    assert_problem(response, 400, "invalid-header", "seconds")


def test_client_deadline_cannot_exceed_the_limit(start: Any, monkeypatch: Any) -> None:
    with start(limits={"deadline": 0.2}) as service, held(monkeypatch):
        response = service.post(
            "/describe", json=request_of([cloud(0)]), headers={"Placecell-Timeout": "50"}
        )
        assert_problem(response, 504, "deadline-exceeded")


def test_work_of_disconnected_clients_is_dropped(
    models_dir: Any, data_dir: Any, monkeypatch: Any
) -> None:
    settings = Settings(models_dir=models_dir, data_dir=data_dir, model="tiny")
    seen: list[int] = []
    original = EigenvalueExtractor.infer

    def counting(self: EigenvalueExtractor, inputs: Inputs) -> Any:
        seen.append(len(inputs["features"]))
        time.sleep(0.2)
        return original(self, inputs)

    monkeypatch.setattr(EigenvalueExtractor, "infer", counting)

    async def call(app: Any, count: int, leave_after: float = 60.0) -> list[dict[str, Any]]:
        return await ask_app(app, request_of([cloud(n) for n in range(count)]), leave_after)

    async def run() -> None:
        with open_state(settings) as state:
            app = create_app(settings, state)
            async with app.router.lifespan_context(app):
                stays = asyncio.create_task(call(app, 1))
                await asyncio.sleep(0.05)
                gone = await asyncio.gather(*[call(app, 3, 0.05) for _ in range(4)])
                assert (await stays)[0]["status"] == 200
                assert all(sent[0]["status"] == 400 for sent in gone)
                assert (await call(app, 2))[0]["status"] == 200

    asyncio.run(run())
    assert seen == [1, 2]


def test_results_do_not_depend_on_concurrent_requests(start: Any) -> None:
    bodies = [request_of([cloud(10 * n + i) for i in range(1 + n % 5)]) for n in range(24)]
    with start(model="onnx", limits={"requests": 64}) as service:
        alone = [service.post("/describe", json=body).json() for body in bodies]
        with ThreadPoolExecutor(12) as pool:
            together = list(pool.map(lambda body: service.post("/describe", json=body), bodies))
        batches = value(service, "placecell_batch_requests_count")
        assert batches < 2 * len(bodies)  # some requests shared a batch
    for one, other in zip(alone, together, strict=True):
        for a, b in zip(one["descriptors"], other.json()["descriptors"], strict=True):
            assert b["descriptor"] == pytest.approx(a["descriptor"], abs=1e-5)
            assert b["codes"] == a["codes"]


def test_every_answer_has_headers_of_id_model_and_times(service: Any, manifest: Any) -> None:
    sent = {"X-Request-Id": "robot-7.42"}
    response = service.post("/describe", json=request_of([cloud(0)]), headers=sent)
    assert response.headers["x-request-id"] == "robot-7.42"
    assert response.headers["placecell-model"] == manifest.model_id
    stages = [part.split(";")[0] for part in response.headers["server-timing"].split(", ")]
    assert stages == ["receive", "queue", "decode", "voxelise", "infer", "encode"]
    forged = service.get("/livez", headers={"X-Request-Id": "a b\tc"})
    assert forged.headers["x-request-id"] != "a b\tc"
    assert len(forged.headers["x-request-id"]) == 16
    assert service.get("/nowhere").headers["placecell-model"] == manifest.model_id


def test_metrics_count_requests_and_stages(service: Any, manifest: Any) -> None:
    from placecell_client import encode

    data = encode(map_of(random_codes(5), manifest.model_id))
    assert service.put("/maps/yard", content=data).status_code == 201
    service.post("/match", json=request_of([cloud(0)]))
    service.get("/maps/unknown")
    requests = 'placecell_requests_total{method="%s",route="%s",status="%s"}'
    assert value(service, requests % ("PUT", "/maps/{map}", 201)) == 1
    assert value(service, requests % ("POST", "/match", 200)) == 1
    assert value(service, requests % ("GET", "/maps/{map}", 404)) == 1
    assert value(service, "placecell_map_segments") == 5
    assert value(service, "placecell_maps") == 1
    assert value(service, 'placecell_writes_total{operation="put"}') == 1
    for stage in ("search", "commit"):
        assert value(service, f'placecell_stage_seconds_count{{stage="{stage}"}}') == 1
    info = f'placecell_model_info{{model_id="{manifest.model_id}",role="default"}}'
    assert value(service, info) == 1
    service.delete("/maps/yard")
    assert value(service, "placecell_map_segments") == 0


def test_body_that_does_not_arrive_answers_408(models_dir: Any, data_dir: Any) -> None:
    settings = Settings.model_validate(
        {"models_dir": models_dir, "data_dir": data_dir, "model": "tiny"}
        | {"limits": {"body_seconds": 0.1, "stall_seconds": 0.2}}
    )

    async def dripping() -> Any:
        yield b'{"segments": '
        await asyncio.sleep(60)

    async def run() -> None:
        with open_state(settings) as state:
            app = create_app(settings, state)
            async with app.router.lifespan_context(app):
                transport = httpx.ASGITransport(app)
                async with httpx.AsyncClient(transport=transport, base_url="http://x") as client:
                    response = await client.post("/describe", content=dripping())
                    assert_problem(response, 408, "slow-body", "0.1 s")
                    response = await client.put("/maps/yard", content=dripping())
                    assert_problem(response, 408, "slow-body", "0.2 s")

    asyncio.run(run())


def test_unknown_methods_and_paths_add_no_metric_labels(service: Any) -> None:
    for n in range(5):
        service.request(f"MADE{n}", "/livez")
        service.get(f"/made-up-{n}")
    text = service.get("/metrics").text
    assert "MADE" not in text
    assert "made-up" not in text
    assert 'method="other"' in text
    assert 'placecell_requests_total{method="GET",route="none",status="404"} 5.0' in text


def test_unexpected_error_answers_500_and_is_counted(service: Any, monkeypatch: Any) -> None:
    def failing(*_: object) -> Any:
        raise RuntimeError("a secret of the inside")

    monkeypatch.setattr(EigenvalueExtractor, "infer", failing)
    response = service.post("/describe", json=request_of([cloud(0)]))
    assert_problem(response, 500, "internal-error")
    assert response.headers["x-request-id"]
    route = 'placecell_requests_total{method="POST",route="/describe",status="500"}'
    assert value(service, route) == 1


def test_too_many_unknown_keys_are_refused_before_parsing(service: Any) -> None:
    body = b"{" + b",".join(b'"%x":0' % n for n in range(300_000)) + b"}"
    assert_problem(service.post("/describe", content=body), 413, "too-many-values")


def test_disconnected_clients_do_not_raise_concurrency(
    models_dir: Any, data_dir: Any, monkeypatch: Any
) -> None:
    """A thread keeps its place until its work ends, even after the client has disconnected."""
    limits = {"requests": 4}
    settings = Settings.model_validate(
        {"models_dir": models_dir, "data_dir": data_dir, "model": "tiny", "limits": limits}
    )
    inside, most = 0, 0
    lock = threading.Lock()

    def slow(*_: object, **__: object) -> Any:
        nonlocal inside, most
        with lock:
            inside += 1
            most = max(most, inside)
        time.sleep(0.05)
        with lock:
            inside -= 1
        raise RuntimeError

    monkeypatch.setattr(EigenvalueExtractor, "prepare", slow)
    body = request_of([cloud(0)])

    async def run() -> None:
        with open_state(settings) as state:
            app = create_app(settings, state)
            async with app.router.lifespan_context(app):
                await asyncio.gather(*[ask_app(app, body, 0.01) for _ in range(20)])

    asyncio.run(run())
    assert most <= settings.workers
