"""OpenTelemetry traces: a span for each request, and one for each of its steps.

Traces are off unless the environment names an exporter (`OTEL_EXPORTER_OTLP_ENDPOINT`,
`OTEL_EXPORTER_OTLP_TRACES_ENDPOINT` or `OTEL_TRACES_EXPORTER`). A thread of the SDK sends the
spans; a request never waits for the collector, and a full queue drops spans.
"""

import logging
import os
import threading
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from time import perf_counter
from typing import TYPE_CHECKING

from service.core.timing import Timing

if TYPE_CHECKING:
    from opentelemetry.sdk.trace import TracerProvider
    from opentelemetry.trace import Span, Tracer

STOP_SECONDS = 2.0
"""Longest time that the end of the service waits until the last spans are sent, seconds."""

ENDPOINTS = ("OTEL_EXPORTER_OTLP_TRACES_ENDPOINT", "OTEL_EXPORTER_OTLP_ENDPOINT")
PROTOCOLS = ("OTEL_EXPORTER_OTLP_TRACES_PROTOCOL", "OTEL_EXPORTER_OTLP_PROTOCOL")
EXPORTERS = "OTEL_TRACES_EXPORTER"
DISABLED = "OTEL_SDK_DISABLED"
HTTP = "http/protobuf"

FAILED = 500
"""Smallest status that marks a span as failed."""

logger = logging.getLogger("placecell")


class TracingError(ValueError):
    """The environment asks for traces that this service cannot send."""


def is_wanted(environment: Mapping[str, str]) -> bool:
    """Return whether the environment asks for traces.

    Raises:
        TracingError: it asks for an exporter or a protocol that is not known.
    """
    exporter = environment.get(EXPORTERS, "").strip().lower()
    if environment.get(DISABLED, "").strip().lower() == "true" or exporter == "none":
        return False
    if exporter not in {"", "otlp"}:
        raise TracingError(f"{EXPORTERS}: found {exporter!r:.40}, expected otlp or none.")
    if not exporter and not any(environment.get(name) for name in ENDPOINTS):
        return False
    protocol = next((environment[name] for name in PROTOCOLS if environment.get(name)), HTTP)
    if protocol != HTTP:
        raise TracingError(
            f"{PROTOCOLS[1]}: found {protocol!r:.40}, expected {HTTP}. Use the collector's port "
            "for HTTP, such as http://collector:4318."
        )
    return True


@contextmanager
def open_tracing(
    version: str, environment: Mapping[str, str] = os.environ
) -> "Iterator[Tracing | None]":
    """Send traces for a block as the environment says; None if it asks for none.

    Args:
        version: version of the service.
        environment: environment variables.

    Raises:
        TracingError: the extra `tracing` is missing, or the environment is not valid.
    """
    if not is_wanted(environment):
        yield None
        return
    try:
        from opentelemetry.exporter.otlp.proto.http.trace_exporter import OTLPSpanExporter
        from opentelemetry.sdk.resources import Resource
        from opentelemetry.sdk.trace import TracerProvider
        from opentelemetry.sdk.trace.export import BatchSpanProcessor
    except ModuleNotFoundError as error:
        raise TracingError(
            "The environment asks for OpenTelemetry traces, which need the extra 'tracing': "
            f"pip install 'placecell[tracing]'. Or set {DISABLED}=true."
        ) from error
    facts = {"service.version": version}
    if not environment.get("OTEL_SERVICE_NAME"):
        facts["service.name"] = "placecell"
    # Its own exit would wait for the collector.
    provider = TracerProvider(resource=Resource.create(facts), shutdown_on_exit=False)
    provider.add_span_processor(BatchSpanProcessor(OTLPSpanExporter()))
    try:
        yield Tracing(provider)
    finally:
        stop = threading.Thread(target=provider.shutdown, daemon=True, name="stop traces")
        stop.start()
        stop.join(STOP_SECONDS)
        if stop.is_alive():
            logger.warning("the last spans were not sent: the collector does not answer")


class Tracing:
    """Source of the spans of requests."""

    def __init__(self, provider: "TracerProvider") -> None:
        # Imported before the first request, which would wait for it.
        from opentelemetry.propagate import extract

        self._extract = extract
        self._tracer = provider.get_tracer("placecell")

    def start(self, method: str, headers: Mapping[str, str], timing: Timing) -> "RequestTrace":
        """Begin the span of a request, as a part of the client's trace if it sent one.

        Args:
            method: HTTP method.
            headers: `traceparent` and `tracestate` of the request, if it has them.
            timing: stopwatch of the request.
        """
        from opentelemetry.trace import SpanKind

        # Laps are in seconds of the stopwatch's clock; spans are in Unix time.
        offset = time.time_ns() - int(1e9 * perf_counter())
        begin = offset + int(1e9 * timing.started)
        span = self._tracer.start_span(
            method, context=self._extract(headers), kind=SpanKind.SERVER, start_time=begin
        )
        return RequestTrace(self._tracer, span, offset)


class RequestTrace:
    """Span of one request.

    Attributes:
        traceresponse: header of the answer that names the span (W3C Trace Context, level 2).
        ids: fields of log lines that name the span.
    """

    def __init__(self, tracer: "Tracer", span: "Span", offset: int) -> None:
        context = span.get_span_context()
        trace_id, span_id = f"{context.trace_id:032x}", f"{context.span_id:016x}"
        self.traceresponse = f"00-{trace_id}-{span_id}-{context.trace_flags:02x}"
        self.ids = {"trace_id": trace_id, "span_id": span_id}
        self._tracer = tracer
        self._span = span
        self._offset = offset

    def end(
        self, name: str, status: int, facts: Mapping[str, str | int | None], timing: Timing
    ) -> None:
        """End the span, and record the request's steps as spans within it.

        Args:
            name: name of the span, such as `POST /match`.
            status: HTTP status of the answer; 0 if there was none.
            facts: attributes; those with None are left out.
            timing: stopwatch of the request.
        """
        from opentelemetry.trace import StatusCode, set_span_in_context

        span = self._span
        if span.is_recording():
            span.update_name(name)
            known = {key: value for key, value in facts.items() if value is not None}
            span.set_attributes(known | {"http.response.status_code": status})
            if not status or status >= FAILED:
                span.set_status(StatusCode.ERROR)
            inside = set_span_in_context(span)
            for stage, begin, end in timing.laps:
                step = self._tracer.start_span(stage, context=inside, start_time=self._at(begin))
                step.end(self._at(end))
        span.end()

    def _at(self, seconds: float) -> int:
        return self._offset + int(1e9 * seconds)
