"""Metrics for Prometheus: counts, times and queue lengths, served on `/metrics`."""

from prometheus_client import CollectorRegistry, Counter, Gauge, Histogram, ProcessCollector

from service.core.timing import STAGES, Timing

SECONDS = (0.0005, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)
COUNTS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)


class Metrics:
    """Metrics of one application, in their own registry."""

    def __init__(self) -> None:
        of = self.registry = CollectorRegistry()
        ProcessCollector(registry=of)
        self.requests = Counter(
            "placecell_requests",
            "Number of requests answered.",
            ["route", "method", "status"],
            registry=of,
        )
        self.seconds = Histogram(
            "placecell_request_seconds",
            "Seconds from the head of the request to the end of the answer.",
            ["route"],
            buckets=SECONDS,
            registry=of,
        )
        self.stages = Histogram(
            "placecell_stage_seconds",
            "Seconds of each step of the requests.",
            ["stage"],
            buckets=SECONDS,
            registry=of,
        )
        for stage in STAGES:
            self.stages.labels(stage)  # a step that never ran is 0, not absent
        self.queue_requests = Gauge(
            "placecell_queue_requests",
            "Number of requests admitted and not yet answered.",
            registry=of,
        )
        self.queue_segments = Gauge(
            "placecell_queue_segments", "Number of segments that wait for the model.", registry=of
        )
        self.batch_segments = Histogram(
            "placecell_batch_segments", "Number of segments per batch.", buckets=COUNTS, registry=of
        )
        self.batch_requests = Histogram(
            "placecell_batch_requests", "Number of requests per batch.", buckets=COUNTS, registry=of
        )
        self.rejected = Counter(
            "placecell_rejected",
            "Number of requests refused, by kind of problem.",
            ["reason"],
            registry=of,
        )
        self.writes = Counter(
            "placecell_writes", "Number of writes to maps.", ["operation"], registry=of
        )
        self.maps = Gauge("placecell_maps", "Number of stored maps.", registry=of)
        self.loaded_maps = Gauge("placecell_loaded_maps", "Number of maps in memory.", registry=of)
        self.store_lag = Gauge(
            "placecell_store_lag_seconds",
            "Seconds since all maps were level with the database; 0 without a database. Up to a "
            "second is usual.",
            registry=of,
        )
        self.map_segments = Gauge(
            "placecell_map_segments", "Number of segments in all maps.", registry=of
        )
        self.robots = Gauge(
            "placecell_robots",
            "Number of robots that reported within limits.robot_seconds.",
            registry=of,
        )
        self.event_clients = Gauge(
            "placecell_event_clients", "Number of streams of events.", registry=of
        )
        self.calibrated = Gauge(
            "placecell_maps_by_calibration",
            "Number of maps that were searched since the start, by the state of the calibration "
            "of their match probabilities.",
            ["state"],
            registry=of,
        )
        self.keys_file_good = Gauge(
            "placecell_keys_file_good",
            "1 if the key file can be read or none is set; 0 otherwise, see /readyz.",
            registry=of,
        )
        self.models = Gauge(
            "placecell_model_info", "1 for each loaded model.", ["model_id", "role"], registry=of
        )

    def observe(self, timing: Timing) -> None:
        """Add the steps of an answered request."""
        for stage, seconds in timing.items():
            self.stages.labels(stage).observe(seconds)
