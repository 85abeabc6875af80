"""Courier: sends the spool, pulls the map and reports the pose, one after the other."""

import re
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

from placecell_client import MapCopy

from robot.core.backoff import Backoff
from robot.core.link import Link, LinkError, RefusedError
from robot.core.link_monitor import LinkMonitor
from robot.core.map_to_odom import MapToOdom
from robot.core.status import AgentStatus
from robot.core.worker import Worker
from robot.localization.local_engine import LocalEngine
from robot.localization.pulled_map import load_copy, save_copy
from robot.mapping.spool import Spool
from robot.mapping.upload import UploadResult, send

LAST_SECONDS = 1.0
"""Longest time to wait for a call when the agent ends, seconds."""
REPORT_SECONDS = 5.0
"""Time between two reports of the robot's pose, seconds."""
BATCH = 20
"""Most edits that are sent in a row, before the map is pulled or the pose reported."""

REQUEST_ID = re.compile(r" \(request [^)]*\)")
"""Id of a request, as an error of the client shows it."""


@dataclass(frozen=True, slots=True)
class _Delivered:
    """Outcome of a job of the courier."""

    job: str
    was_reached: bool | None = None
    error: str | None = None
    retry_after: float | None = None
    upload: UploadResult | None = None
    replaced: bool = False
    refused: str | None = None


@dataclass(slots=True)
class CourierReport:
    """Work of the courier since the last step.

    Attributes:
        uploads: edits that the service took.
        messages: lines for the user.
        map_replaced: whether the map to localize in is another one now.
    """

    uploads: int = 0
    messages: list[str] = field(default_factory=list)
    map_replaced: bool = False


class Courier:
    """Transfers that can wait; `step` starts the next one and returns what is done.

    Attributes:
        upload_maps: maps that received edits.
        refused: edits that the service will never take.
    """

    def __init__(
        self,
        link: Link,
        spool: Spool,
        engine: LocalEngine | None,
        monitor: LinkMonitor,
        clock: Callable[[], float],
        worker: Worker[_Delivered],
        names: tuple[str, str, str],
        folder: Path | None,
        pull_seconds: float,
    ) -> None:
        """Load the copy of the map.

        Args:
            link: link to the service.
            spool: edits to send.
            engine: engine that searches the pulled map; None: no map is pulled.
            monitor: state of the link.
            clock: monotonic clock, seconds.
            worker: makes the calls.
            names: name of the map to write, of the map to pull, and of the robot.
            folder: folder of the pulled map; None keeps it in memory.
            pull_seconds: time between two pulls.
        """
        self._link = link
        self._spool = spool
        self._engine = engine
        self._monitor = monitor
        self._clock = clock
        self._backoff = Backoff(clock)
        self._worker = worker
        self._write_name, self._pull_name, self._robot = names
        self._folder = folder
        self._pull_seconds = pull_seconds
        self._next_pull = clock()
        self._next_report = clock()
        self._copy = MapCopy(self._pull_name)
        self._last_error = ""
        self.upload_maps: list[str] = []
        self.refused = 0
        if engine is not None:
            self._copy = load_copy(self._pull_name, folder)
            if self._copy.content is not None and self._copy.etag is not None:
                try:
                    engine.set_map(self._copy.content, self._copy.etag)
                except ValueError:  # Another model made it: the next pull says what to do.
                    self._copy = MapCopy(self._pull_name)

    @property
    def is_idle(self) -> bool:
        """Whether no job is running and no edit waits."""
        return not self._worker.is_busy and self._spool.status().entries == 0

    @property
    def seconds_to_wait(self) -> float:
        """Seconds until the next call may be made."""
        return self._backoff.remaining

    def step(self, status: AgentStatus, pose: MapToOdom | None) -> CourierReport:
        """Take the result of the last job, and start the next one.

        Args:
            status: state of the agent, to report.
            pose: pose of the sensor in the map, or None.
        """
        report = CourierReport()
        done = self._worker.take()
        if done is not None:
            self._handle(done, report)
        if not self._worker.is_busy and self._backoff.is_over:
            self._start(status, pose)
        return report

    def finish(self, status: AgentStatus, pose: MapToOdom | None) -> CourierReport:
        """Take the result of the running job, and report the last state of a robot that ends.

        It waits a second at most for each, and does not report while the service is away.
        """
        report = CourierReport()
        if self._worker.wait(LAST_SECONDS) and (done := self._worker.take()) is not None:
            self._handle(done, report)
        takes_reports = self._next_report < float("inf") and self._backoff.is_over
        if takes_reports and not self._worker.is_busy and not self._monitor.is_offline:
            told = "; ".join(filter(None, (status.reason, "the agent has ended")))
            last = replace(status, reason=told)
            self._worker.submit(lambda: self._report(last, pose))
            self._worker.wait(LAST_SECONDS)
        return report

    def wait(self, seconds: float) -> bool:
        """Wait until the running job has finished."""
        return self._worker.wait(seconds)

    def close(self) -> None:
        """Stop the worker."""
        self._worker.close()

    def _start(self, status: AgentStatus, pose: MapToOdom | None) -> None:
        now = self._clock()
        entries = self._spool.oldest(BATCH)
        pull_is_due = self._engine is not None and now >= self._next_pull
        is_probe = self._engine is not None and self._monitor.is_offline and not entries
        if pull_is_due or is_probe:
            self._next_pull = now + self._pull_seconds
            self._worker.submit(self._pull)
        elif entries:
            known = {
                (each.session, each.part): chosen
                for each in entries
                if (chosen := self._spool.map_of(each.session, each.part)) is not None
            }
            name, robot = self._write_name, self._robot
            self._worker.submit(lambda: _uploaded(send(self._link, entries, known, name, robot)))
        elif now >= self._next_report:
            self._next_report = now + REPORT_SECONDS
            self._worker.submit(lambda: self._report(status, pose))

    def _handle(self, done: _Delivered, report: CourierReport) -> None:
        if done.was_reached is not None:
            self._monitor.note(done.was_reached)
        if done.upload is not None:
            self._settle(done.upload, report)
        report.map_replaced = done.replaced
        if done.refused is not None:
            report.messages.append(f"{done.job}: {done.refused}")
        if done.error is None:
            self._backoff.succeeded()
            self._last_error = ""
            return
        self._backoff.failed(done.retry_after)
        told = REQUEST_ID.sub("", done.error)  # It differs from call to call.
        if told != self._last_error:
            report.messages.append(f"{done.job}: {done.error}")
        self._last_error = told

    def _settle(self, result: UploadResult, report: CourierReport) -> None:
        for entry, chosen in result.sent:
            if self._spool.map_of(entry.session, entry.part) != chosen:
                self._spool.set_map(entry.session, entry.part, chosen)
            if chosen not in self.upload_maps:
                self.upload_maps.append(chosen)
                report.messages.append(f"segments go to map {chosen!r}")
            self._spool.remove(entry)
            report.uploads += 1
        if result.refused is not None:
            entry, why = result.refused
            self._spool.remove(entry)
            self.refused += 1
            report.messages.append(f"the service refuses an edit, which is dropped: {why}")

    def _pull(self) -> _Delivered:
        before, frame = self._copy.sequence, self._copy.content and self._copy.content.frame
        try:
            copy = self._link.pull(self._copy)
            if self._engine is not None and copy.content is not None and copy.etag is not None:
                self._engine.set_map(copy.content, copy.etag)
        except LinkError as error:
            return _Delivered("pull", error.was_reached, str(error), error.retry_after)
        except (RefusedError, ValueError) as error:
            # There is no such map yet, or the key does not open it.
            told = None if isinstance(error, RefusedError) and error.status == 404 else str(error)
            return _Delivered("pull", True, told)
        if self._folder is not None and copy.sequence != before:
            save_copy(copy, self._folder)
        self._copy = copy
        is_other = frame is not None and (
            copy.sequence < before or copy.content is None or copy.content.frame != frame
        )
        return _Delivered("pull", True, replaced=is_other)

    def _report(self, status: AgentStatus, pose: MapToOdom | None) -> _Delivered:
        try:
            self._link.report(self._robot, status, pose)
        except LinkError as error:
            return _Delivered("report", error.was_reached, str(error), error.retry_after)
        except RefusedError as error:
            # An older service, a key that may not report, or a name that it does not take.
            self._next_report = float("inf")
            return _Delivered("report", True, refused=f"others do not see this robot: {error}")
        return _Delivered("report", True)


def _uploaded(result: UploadResult) -> _Delivered:
    return _Delivered("upload", result.was_reached, result.error, result.retry_after, result)
