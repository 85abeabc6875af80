"""Traces: a span for each request and its steps, within the client's trace, and never a wait."""

import logging
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, HTTPServer
from time import perf_counter
from typing import Any

import pytest
from placecell_client import Client

from service.api import state
from service.core import tracing
from service.core.timing import LAPS, Timing
from service.core.tracing import Tracing, TracingError, is_wanted, open_tracing
from service.engine import StartError
from tests.service.service_builders import cloud, request_of

pytest.importorskip("opentelemetry.sdk.trace")
CALLER = "00-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-01"
ENDPOINT = "OTEL_EXPORTER_OTLP_ENDPOINT"


@pytest.fixture
def exporter(monkeypatch: pytest.MonkeyPatch) -> Any:
    """The spans of a service that is started after this."""
    from opentelemetry.sdk.trace import TracerProvider
    from opentelemetry.sdk.trace.export import SimpleSpanProcessor
    from opentelemetry.sdk.trace.export.in_memory_span_exporter import InMemorySpanExporter

    exporter = InMemorySpanExporter()
    provider = TracerProvider(shutdown_on_exit=False)
    provider.add_span_processor(SimpleSpanProcessor(exporter))

    @contextmanager
    def opened(version: str) -> Iterator[Tracing]:
        del version
        yield Tracing(provider)

    monkeypatch.setattr(state, "open_tracing", opened)
    return exporter


def by_name(exporter: Any) -> dict[str, Any]:
    return {span.name: span for span in exporter.get_finished_spans()}


def test_request_and_its_steps_are_spans_of_the_callers_trace(
    exporter: Any, service: Any, caplog: pytest.LogCaptureFixture
) -> None:
    with caplog.at_level(logging.INFO, "placecell.requests"):
        response = service.post(
            "/describe",
            json=request_of([cloud(1), cloud(2)]),
            headers={"traceparent": CALLER, "X-Request-Id": "robot-7.3"},
        )
    assert response.status_code == 200
    spans = by_name(exporter)
    request = spans.pop("POST /describe")
    assert f"{request.context.trace_id:032x}" == CALLER.split("-")[1]
    assert f"{request.parent.span_id:016x}" == CALLER.split("-")[2]
    assert request.kind.name == "SERVER"
    assert request.attributes["http.response.status_code"] == 200
    assert request.attributes["placecell.request_id"] == "robot-7.3"
    assert request.attributes["http.route"] == "/describe"
    assert {"receive", "decode", "infer", "encode"} <= {*spans}
    for step in spans.values():
        assert step.parent.span_id == request.context.span_id
        assert request.start_time <= step.start_time <= step.end_time <= request.end_time
    trace_id, span_id = response.headers["Traceresponse"].split("-")[1:3]
    assert (trace_id, span_id) == (CALLER.split("-")[1], f"{request.context.span_id:016x}")
    (record,) = (each for each in caplog.records if each.name == "placecell.requests")
    assert record.__dict__["trace_id"] == trace_id
    assert record.__dict__["request_id"] == "robot-7.3"


@pytest.mark.parametrize("given", ["", "00-zz", "x" * 5_000, "00-" + "0" * 32 + "-" + "0" * 16])
def test_request_without_a_valid_trace_begins_one(exporter: Any, service: Any, given: str) -> None:
    assert service.get("/maps/none", headers={"traceparent": given}).status_code == 404
    (request,) = exporter.get_finished_spans()
    assert request.parent is None
    assert request.status.status_code.name == "UNSET"


def test_unsampled_request_leaves_no_span(exporter: Any, service: Any) -> None:
    headers = {"traceparent": CALLER[:-1] + "0"}
    response = service.get("/livez", headers=headers)
    assert response.headers["Traceresponse"].endswith("-00")
    assert by_name(exporter) == {}


def test_probes_are_spans_and_log_lines_only_if_they_are_asked_for(
    exporter: Any, service: Any, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    caplog.set_level(logging.INFO, "placecell.requests")
    for path in ("/livez", "/readyz", "/metrics"):
        assert "Traceresponse" not in service.get(path).headers
    assert by_name(exporter) == {}
    assert caplog.records == []
    assert "Traceresponse" in service.get("/readyz", headers={"traceparent": CALLER}).headers
    assert [*by_name(exporter)] == ["GET /readyz"]
    engine = service.app.state.placecell.engine
    monkeypatch.setattr(type(engine), "unready", lambda _: "It fails.")
    assert service.get("/readyz").status_code == 503
    assert [each.getMessage() for each in caplog.records] == ["GET /readyz 503"]


def test_failed_request_is_an_error(
    exporter: Any, service: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    placecell = service.app.state.placecell
    monkeypatch.setattr(type(placecell), "model_id", property(lambda _: "m"))
    monkeypatch.setattr(placecell.engine.maps, "entries", lambda: 1 / 0)
    assert service.get("/maps").status_code == 500
    assert by_name(exporter)["GET /maps"].status.status_code.name == "ERROR"


def test_without_traces_there_is_no_header(service: Any) -> None:
    assert "Traceresponse" not in service.get("/livez").headers


def test_client_continues_the_present_trace_and_names_its_request(
    exporter: Any, start: Callable[..., Any]
) -> None:
    from opentelemetry.sdk.trace import TracerProvider

    tracer = TracerProvider(shutdown_on_exit=False).get_tracer("robot")
    with start() as service:
        client = Client("http://127.0.0.1:1", transport=service._transport)
        with tracer.start_as_current_span("look around") as outer:
            client.info()
        client.info()
    first, second = exporter.get_finished_spans()
    assert first.context.trace_id == outer.get_span_context().trace_id
    assert second.parent is None


@pytest.mark.parametrize(
    ("environment", "wanted"),
    [
        ({}, False),
        ({ENDPOINT: ""}, False),
        ({ENDPOINT: "http://c:4318"}, True),
        ({"OTEL_EXPORTER_OTLP_TRACES_ENDPOINT": "http://c:4318/v1/traces"}, True),
        ({"OTEL_TRACES_EXPORTER": "otlp"}, True),
        ({"OTEL_TRACES_EXPORTER": "none", ENDPOINT: "http://c:4318"}, False),
        ({"OTEL_SDK_DISABLED": "TRUE", ENDPOINT: "http://c:4318"}, False),
        ({"OTEL_EXPORTER_OTLP_PROTOCOL": "http/protobuf", ENDPOINT: "http://c:4318"}, True),
    ],
)
def test_traces_are_off_unless_asked_for(environment: dict[str, str], wanted: bool) -> None:
    assert is_wanted(environment) == wanted


@pytest.mark.parametrize(
    ("environment", "words"),
    [
        ({"OTEL_TRACES_EXPORTER": "zipkin"}, "found 'zipkin', expected otlp or none"),
        (
            {ENDPOINT: "http://c:4317", "OTEL_EXPORTER_OTLP_PROTOCOL": "grpc"},
            "found 'grpc', expected http/protobuf",
        ),
    ],
)
def test_unknown_exporters_are_named(environment: dict[str, str], words: str) -> None:
    with pytest.raises(TracingError, match=words):
        is_wanted(environment)


def test_missing_extra_is_named_at_the_start(
    start: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(ENDPOINT, "http://127.0.0.1:1")
    monkeypatch.setitem(sys.modules, "opentelemetry.exporter.otlp.proto.http.trace_exporter", None)
    with (
        pytest.raises(StartError, match=r"pip install 'placecell\[tracing\]'"),
        start(),
    ):
        pass


class SilentCollector(BaseHTTPRequestHandler):
    """Takes spans, and never answers until the test ends."""

    taken = threading.Event()
    ends = threading.Event()

    def do_POST(self) -> None:
        """Read the spans and wait."""
        self.rfile.read(int(self.headers["Content-Length"]))
        self.taken.set()
        self.ends.wait(30)

    def log_message(self, *_: object) -> None:
        """Write no log."""


def test_silent_collector_delays_neither_requests_nor_the_end(
    start: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tracing, "STOP_SECONDS", 0.2)
    server = HTTPServer(("127.0.0.1", 0), SilentCollector)
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    try:
        monkeypatch.setenv(ENDPOINT, f"http://127.0.0.1:{server.server_port}")
        monkeypatch.setenv("OTEL_BSP_SCHEDULE_DELAY", "10")
        with start() as service:
            assert service.get("/info").headers["Traceresponse"]
            assert SilentCollector.taken.wait(20)
            begin = perf_counter()
            assert service.get("/info").status_code == 200
        assert perf_counter() - begin < 10
    finally:
        SilentCollector.ends.set()
        server.shutdown()
        thread.join(10)
        server.server_close()


def test_spans_reach_a_collector() -> None:
    bodies: list[bytes] = []
    arrived = threading.Event()

    class Collector(BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            bodies.append(self.rfile.read(int(self.headers["Content-Length"])))
            self.send_response(200)
            self.end_headers()
            arrived.set()

        def log_message(self, *_: object) -> None:
            pass

    server = HTTPServer(("127.0.0.1", 0), Collector)
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    with pytest.MonkeyPatch.context() as patched:
        patched.setenv(ENDPOINT, f"http://127.0.0.1:{server.server_port}")
        patched.setenv("OTEL_EXPORTER_OTLP_TIMEOUT", "1")
        try:
            with open_tracing("1.2.3") as opened:
                assert opened is not None
                trace = opened.start("GET", {}, Timing())
                trace.end("GET /livez", 200, {"none": None}, Timing())
            assert arrived.wait(20)
        finally:
            server.shutdown()
            thread.join(10)
            server.server_close()
    assert b"GET /livez" in bodies[0]
    assert b"1.2.3" in bodies[0]


def test_laps_are_kept_one_by_one_up_to_a_bound() -> None:
    timing = Timing()
    for _ in range(LAPS + 5):
        timing.lap("infer")
    assert len(timing.laps) == LAPS
    assert timing.laps[0][1] == timing.started
    assert all(begin <= end for _, begin, end in timing.laps)
    assert [one[2] for one in timing.laps[:-1]] == [one[1] for one in timing.laps[1:]]
