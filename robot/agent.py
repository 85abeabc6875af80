"""The agent: turns scans and odometry into fixes in a map, and into edits of a map."""

import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from placecell_client.maps.follow import moved_at

from placecell.core.types import Float32, Float64
from robot.core.link import FixAnswer, FixRequest, Link
from robot.core.link_monitor import LinkMonitor
from robot.core.map_to_odom import MapToOdom
from robot.core.settings import AgentSettings
from robot.core.status import AgentState, AgentStatus, Fix, Summary
from robot.core.worker import Worker
from robot.courier import Courier
from robot.localization.correction import RIGHT_METERS, RIGHT_RADIANS, Correction
from robot.localization.last_pose import LastPose
from robot.localization.local_engine import LocalEngine
from robot.localization.rigid import inverse
from robot.localization.state import LocalizationState
from robot.localizer import Localizer
from robot.mapping.map_out import MapEdit
from robot.mapping.perception import Keyframe, Perception, PerceptionStep
from robot.mapping.spool import Spool
from robot.outputs.output import AgentOutput, OutputGroup

CHECKPOINT_KEYFRAMES = 20
"""Number of keyframes between two checkpoints: what a restarted agent does again, at most."""
INSIDE_METERS = 20.0
"""Distance from the path of the map's robots up to which a robot is inside the map: half of the
radius of a local map."""
JUMP_METERS = 10.0
"""Distance of two poses from which a jump means that the robot was carried away."""

FOLLOWED_METERS = 0.01
"""Movement of the map around the robot from which its pose follows, meters."""
SAVED_METERS = 0.5
"""Distance between two records of the last pose."""
MOVED = np.array([0.5, 0.5, 0.5, 0.02, 0.02, 0.1])
"""How far a robot may be moved while it is off, as standard deviations: meters and radians."""
LONGEST_WAIT = 60.0
"""Longest time between two looks at the transfers at the end, seconds; any total is allowed."""
FARTHEST_METERS = 5e7
"""Largest coordinate of the odometry, meters: half of what a map's file can hold."""
NO_ROTATION = 0.01
"""Difference from the identity of a pose's rotation times its transpose, from which it is none."""
CLOCK_GAP = 2.0
"""Time between two scans that is told, seconds."""


class RobotAgent:
    """Agent of one robot. Give it each scan with the pose of the odometry, and close it.

        with robot_client("http://127.0.0.1:8000") as client:
            agent = RobotAgent(AgentSettings(map="yard"), ServiceLink(client))
            for points, time_s, odom_pose in scans:
                agent.on_scan(points, time_s, odom_pose)
                print(agent.status.state, agent.map_to_odom)
            print(agent.close())

    Calls come from one thread. The agent reads no clock but the one that is passed in, which only
    paces the link; times come with the scans.

    Attributes:
        settings: settings of the agent.
        status: state of the agent.
        map_to_odom: where the odometry frame lies in the map; None if it is not known.
        messages: lines for the user since the last scan.
    """

    def __init__(
        self,
        settings: AgentSettings,
        link: Link | None = None,
        outputs: Sequence[AgentOutput] = (),
        clock: Callable[[], float] = time.monotonic,
        engine: LocalEngine | None = None,
        make_worker: Callable[[str], Worker[Any]] = Worker,
    ) -> None:
        """Open the state folder and load the model.

        Args:
            settings: settings of the agent.
            link: link to the service; None: the robot never has one.
            outputs: receivers of poses, fixes, states and segments.
            clock: monotonic clock, seconds.
            engine: engine to describe and to localize with; None loads the default model.
            make_worker: makes the workers that call the service.

        Raises:
            OSError: the state folder cannot be written.
        """
        self.settings = settings
        self.map_to_odom: MapToOdom | None = None
        self.messages: list[str] = []
        self._outputs = OutputGroup(outputs, self.messages.append)
        self._clock = clock
        self._engine = engine or LocalEngine(settings.model)
        self._owns_engine = engine is None
        self._spool = Spool.open(
            settings.state, settings.session, settings.spool_bytes, self.messages.append
        )
        self._monitor = LinkMonitor()
        self._localizer = Localizer(
            link, self._engine, self._monitor, clock, make_worker("placecell-localize")
        )
        self._courier = None
        if link is not None:
            maps = settings.maps_folder or (settings.state and settings.state / "maps")
            self._courier = Courier(
                link=link,
                spool=self._spool,
                engine=self._engine if settings.localize else None,
                monitor=self._monitor,
                clock=clock,
                worker=make_worker("placecell-transfer"),
                names=(settings.written_map, settings.searched_map, settings.robot),
                folder=maps,
                pull_seconds=settings.pull_seconds,
            )
        self._perception, self.first_scan = self._resume()
        self._state = LocalizationState()
        self._correction = Correction(settings.drift)
        self._last_request = -np.inf
        self._asks_now = False
        self._odom_pose = np.eye(4)
        self._time: float | None = None
        self._counts = dict.fromkeys(
            ("dropped", "segments", "fixes", "refused", "kidnaps", "uploads"), 0
        )
        self._meters_at_first_fix: float | None = None
        self._meters_at_start = self._perception.meters
        self._last_fix: Fix | None = None
        self.status = AgentStatus(map=settings.searched_map)
        self._saved_at = -np.inf
        self._is_closed = False

    def on_scan(
        self,
        points: Float32,
        time_s: float,
        odom_pose: Float64,
        odom_covariance: Float64 | None = None,
    ) -> None:
        """Process a scan.

        Args:
            points: float32 (n, 3), meters, in the sensor's frame, deskewed.
            time_s: time of the scan, seconds.
            odom_pose: pose of the sensor in the odometry frame (z up), float64 (4, 4).
            odom_covariance: covariance of this pose since the odometry began, of x, y, z and the
                rotations about the frame's axes, float64 (6, 6); None if it is not known. The map
                states its growth from capture to capture.
        """
        self.messages.clear()
        wrong = fault_of_pose(odom_pose, time_s)
        if wrong:
            self.messages.append(f"a scan is left out: {wrong}")
            self.drop_scan()
            return
        self._note_time(time_s)
        self._odom_pose = odom_pose
        if self._state.state is AgentState.STARTING:
            self._start()
        self._take_answer()
        self._follow_map()
        # Maps and filters need classes: a robot without either saves the time.
        classified = self.settings.upload or bool(self.settings.ignore)
        describe = partial(self._engine.describe, classified=classified)
        step = self._perception.add(points, time_s, odom_pose, describe, odom_covariance)
        self._handle_jump(step)
        if step.keyframe is not None:
            self._handle_keyframe(step.keyframe, step.edit)
        self._step_courier()
        self._publish(points)

    def drop_scan(self) -> None:
        """Count a scan that came too late and is not processed."""
        self._perception.skip()
        self._counts["dropped"] += 1

    def on_initial_pose(self, map_pose: Float64, covariance: Float64) -> None:
        """Take a pose that a person gave as the pose of the robot at the last scan.

        Args:
            map_pose: pose of the sensor in the map, float64 (4, 4).
            covariance: covariance of x, y, z and the rotations about the map's axes, (6, 6).
        """
        fix = Fix(
            time=self._time or 0.0,
            map=self.settings.searched_map,
            pose=map_pose,
            covariance=covariance,
            probability=1.0,
            source="operator",
            meters=self._perception.meters,
            accepted=True,
        )
        self._correction.place(fix, map_pose @ inverse(self._odom_pose))
        self._state.placed()
        self._asks_now = True
        self._outputs.fix(fix)
        self._update()

    def localize_now(self) -> None:
        """Request a pose at the next scan, however near the last request was."""
        self._asks_now = True
        self._perception.keyframe_now()

    def wait(self, seconds: float) -> bool:
        """Wait for the answer to the last request, and take it.

        Args:
            seconds: longest time to wait.

        Returns:
            Whether no request is without an answer.
        """
        if not self._localizer.wait(seconds):
            return False
        self._take_answer()
        self._update()
        return True

    def wait_for_uploads(self, seconds: float) -> bool:
        """Send edits until the spool is empty; return whether it is.

        Args:
            seconds: longest time to wait.
        """
        end = self._clock() + seconds
        while self._courier is not None and not self._courier.is_idle:
            left = end - self._clock()
            if left <= 0:
                return False
            self._courier.wait(min(left, LONGEST_WAIT))
            self._step_courier()
            if self._courier.seconds_to_wait > 0:
                time.sleep(min(left, self._courier.seconds_to_wait, 0.5))
        return self._spool.status().entries == 0

    def finish(self) -> None:
        """Note that the drive ends here: the same session begins anew next time."""
        self._spool.finish()

    def close(self) -> Summary:
        """Close outputs, link and state folder; return the summary."""
        if not self._is_closed:
            self._is_closed = True
            self._update()
            self._localizer.close()
            if self._courier is not None:
                with suppress(OSError):  # a pulled map that a full disk could not keep
                    self._step_courier(is_last=True)
                self._courier.close()
            self._outputs.close()
            self._summary = self._summarize()
            self._spool.close()
            if self._owns_engine:
                self._engine.close()
        return self._summary

    def _resume(self) -> tuple[Perception, int]:
        """Return the state of the last checkpoint, or a new one, and the number of its scans."""
        progress = self._spool.progress()
        if progress.checkpoint is not None and not progress.finished:
            found = Perception.load(progress.checkpoint, self._engine.model_id)
            if found is not None:
                self.messages.append(f"the agent continues after scan {found.scans}")
                return found, found.scans
            self.messages.append("the checkpoint cannot be used: the drive is processed anew")
        settings = self.settings
        begun = Perception.begin(
            robot=settings.robot,
            session=settings.session,
            parameters=settings.parameters,
            keyframe_meters=settings.keyframe_meters,
            model_id=self._engine.model_id,
            preprocessing=self._engine.preprocessing,
            keep_moving=settings.keep_moving,
            unmapped=settings.unmapped,
        )
        return begun, 0

    def _start(self) -> None:
        settings = self.settings
        self._state.started(settings.localize)
        if settings.state is None or not settings.localize:
            return
        last = LastPose.load(settings.state)
        if last is None or last.map != settings.searched_map:
            return
        same_frame = (last.session, last.part) == (settings.session, self._perception.part)
        odom_pose = last.odom_pose if same_frame else self._odom_pose
        # A guess: one fix that agrees confirms it.
        guess = self._fix(last.pose, last.covariance + np.diag(MOVED**2), 0.0, "local", -1.0)
        self._correction.guess(guess, last.pose @ inverse(odom_pose))

    def _note_time(self, time_s: float) -> None:
        before, self._time = self._time, time_s
        if before is None:
            return
        if time_s < before:
            self.messages.append(f"the clock of the scans went back by {before - time_s:.3f} s")
        elif time_s - before > CLOCK_GAP:
            self.messages.append(f"no scan for {time_s - before:.1f} s")

    def _follow_map(self) -> None:
        """Move the pose with the map, if an optimization moved its captures around the robot."""
        replaced = self._engine.take_replaced()
        if replaced is None or self._correction.transform is None:
            return
        position = (self._correction.transform @ self._odom_pose)[:3, 3]
        moved = moved_at(*replaced, position.tolist())
        if moved is None:
            return
        meters = float(np.linalg.norm(moved[:3, :3] @ position + moved[:3, 3] - position))
        if meters > FOLLOWED_METERS:
            self._correction.follow(moved)
            self._asks_now = True
            self.messages.append(f"the map was corrected here: the pose moves by {meters:.2f} m")

    def _handle_jump(self, step: PerceptionStep) -> None:
        if step.jump == "doubt":
            self._state.doubted()
        elif step.jump == "cleared":
            self._state.cleared()
        elif step.jump == "carried away":
            self.messages.append("the scans show another place: the robot was carried away")
            self._counts["kidnaps"] += 1
            self._correction.reset()
            self._state.carried_away()
            self._last_request = -np.inf
            if self._state.state is AgentState.MAPPING and self.settings.localize:
                # The new odometry frame is not that of the map which was made so far.
                self._state.relocalize("the robot was carried away from the map that it made")

    def _handle_keyframe(self, keyframe: Keyframe, edit: MapEdit | None) -> None:
        assert self._time is not None
        self._outputs.segments(self._time, keyframe.live.segments, keyframe.live.ids)
        if edit is not None and self.settings.upload:
            self._spool_edit(edit)
        if self._perception.keyframes % CHECKPOINT_KEYFRAMES == 0 and self.settings.state:
            self._spool.save(self._perception.scans, self._perception.checkpoint())
        if self.settings.localize:
            self._localize(keyframe)

    def _spool_edit(self, edit: MapEdit) -> None:
        if not self._spool.add(edit.sequence, edit.part, edit.content, edit.segments):
            self.messages.append(
                f"{edit.segments} segments are not stored: the spool or the disk is full"
            )
            return
        self._counts["segments"] += edit.segments

    def _localize(self, keyframe: Keyframe) -> None:
        if self._makes_searched_map():
            if self._state.state is not AgentState.MAPPING:
                self._correction.reset()
                self._state.own_map(self.settings.searched_map)
            return
        meters = self._perception.meters
        is_sure = self._state.state is AgentState.TRACKING
        due = self.settings.localize_meters if is_sure else 0.0
        if meters - self._last_request < due and not self._asks_now:
            return
        if not len(keyframe.codes):
            self._miss("no segment is in sight")
            return
        if self._localizer.ask(self._request(keyframe)):
            self._last_request, self._asks_now = meters, False

    def _request(self, keyframe: Keyframe) -> FixRequest:
        assert self._time is not None
        meters = self._perception.meters
        return FixRequest(
            time=self._time,
            meters=meters,
            odom_pose=self._odom_pose,
            part=self._perception.part,
            model_id=self._engine.model_id,
            codes=keyframe.codes,
            centroids=keyframe.centroids,
            map=self.settings.searched_map,
            session=f"{self.settings.robot}-{self.settings.session}-{self._perception.part}"[-64:],
            classes=keyframe.classes,
            ignore=self.settings.ignore,
            heights=keyframe.heights,
        )

    def _take_answer(self) -> None:
        answer = self._localizer.answer()
        if answer is None or answer.request.part != self._perception.part:
            return  # An answer from before the robot was carried away says nothing.
        if answer.transform is None or answer.covariance is None:
            self._miss(answer.reason)
        else:
            self._use(answer, answer.transform, answer.covariance)

    def _use(self, answer: FixAnswer, transform: Float64, covariance: Float64) -> None:
        request = answer.request
        pose = transform @ request.odom_pose
        fix = self._fix(pose, covariance, answer.probability, answer.source, request.meters)
        before = self._correction.at(request.time, request.meters)
        verdict = self._correction.add(fix, transform)
        accepted = verdict in ("first", "confirmed", "jump")
        reason = "" if accepted else self._reason_of(verdict)
        fix = Fix(
            time=request.time,
            map=fix.map,
            pose=pose,
            covariance=covariance,
            probability=answer.probability,
            source=answer.source,
            meters=request.meters,
            accepted=accepted,
            reason=reason,
        )
        self._state.fixed(verdict)
        if accepted:
            self._counts["fixes"] += 1
            self._last_fix = fix
            if self._meters_at_first_fix is None:
                self._meters_at_first_fix = request.meters
            if verdict == "jump" and before is not None:
                moved = pose[:3, 3] - (before.transform @ request.odom_pose)[:3, 3]
                self._counts["kidnaps"] += bool(np.linalg.norm(moved) > JUMP_METERS)
        else:
            self._counts["refused"] += 1
            self._asks_now = True
        self._outputs.fix(fix)

    @staticmethod
    def _reason_of(verdict: str) -> str:
        if verdict == "contradicts":
            return "it contradicts the odometry since the last fix; another one must agree"
        return "another fix must agree"

    def _fix(
        self, pose: Float64, covariance: Float64, probability: float, source: Any, meters: float
    ) -> Fix:
        name = self.settings.searched_map
        return Fix(self._time or 0.0, name, pose, covariance, probability, source, meters, False)

    def _miss(self, reason: str) -> None:
        expected = self._correction.at(self._time or 0.0, self._perception.meters)
        outside, uncertain = None, False
        if expected is not None:
            position = expected.pose(self._odom_pose)[:3, 3]
            away = self._engine.meters_from_map(position)
            outside = None if away is None else away > INSIDE_METERS
            spread = np.sqrt(np.diag(expected.covariance))
            uncertain = bool(max(spread[:2]) > RIGHT_METERS or spread[5] > RIGHT_RADIANS)
        self._state.missed(reason, outside, uncertain)

    def _makes_searched_map(self) -> bool:
        """Return whether the map to localize in is the one that this odometry frame makes."""
        if not self.settings.upload:
            return False
        chosen = self._spool.map_of(self.settings.session, self._perception.part)
        return chosen == self.settings.searched_map

    def _step_courier(self, is_last: bool = False) -> None:
        if self._courier is None:
            return
        step = self._courier.finish if is_last else self._courier.step
        found = self.map_to_odom
        if found is not None:
            found = replace(found, transform=found.pose(self._odom_pose))
        report = step(self.status, found)
        self._counts["uploads"] += report.uploads
        self.messages += report.messages
        if report.map_replaced and self.settings.localize:
            self.messages.append(f"map {self.settings.searched_map!r} was replaced")
            self._correction.reset()
            self._state.map_replaced(self.settings.searched_map)

    def _publish(self, points: Float32) -> None:
        self._update()
        assert self._time is not None
        self._outputs.scan(self._time, points, self._odom_pose, self.map_to_odom)

    def _update(self) -> None:
        """Bring status and correction up to date; report a change of the state or of the link."""
        meters, now = self._perception.meters, self._time or 0.0
        if self._state.state is AgentState.MAPPING:
            self.map_to_odom = MapToOdom(np.eye(4), np.zeros((6, 6)), self.settings.map, now)
        else:
            self.map_to_odom = self._correction.at(now, meters)
        before = self.status
        chosen = self._spool.map_of(self.settings.session, self._perception.part)
        self.status = AgentStatus(
            time=now,
            state=self._state.state,
            reason=self._state.reason,
            link=self._monitor.state,
            map=self.settings.searched_map,
            upload_map=chosen or "",
            scans=self._perception.scans - self._counts["dropped"],
            scans_dropped=self._counts["dropped"],
            meters=meters,
            fixes=self._counts["fixes"],
            last_fix=self._last_fix,
            spool=self._spool.status(),
        )
        if (before.state, before.link) != (self.status.state, self.status.link):
            self._outputs.status(self.status)
            self._save_pose()
        elif meters - self._saved_at >= SAVED_METERS:
            self._save_pose()

    def _save_pose(self) -> None:
        """Save the pose while it is sure."""
        found, folder = self.map_to_odom, self.settings.state
        if folder is None or found is None or self.status.state is not AgentState.TRACKING:
            return
        self._saved_at = self.status.meters
        LastPose(
            map=found.map,
            session=self.settings.session,
            part=self._perception.part,
            pose=found.pose(self._odom_pose),
            odom_pose=self._odom_pose,
            covariance=found.covariance,
            time=found.time,
        ).save(folder)

    def _summarize(self) -> Summary:
        counts = self._counts
        first = self._meters_at_first_fix
        maps = () if self._courier is None else tuple(self._courier.upload_maps)
        return Summary(
            meters=self._perception.meters - self._meters_at_start,
            scans=self.status.scans,
            scans_dropped=counts["dropped"],
            keyframes=self._perception.keyframes,
            segments=counts["segments"],
            fixes=counts["fixes"],
            fixes_refused=counts["refused"],
            meters_until_first_fix=None if first is None else first - self._meters_at_start,
            kidnaps=counts["kidnaps"],
            uploads=counts["uploads"],
            spool=self.status.spool,
            upload_maps=maps,
            state=self.status.state,
            link=self.status.link,
        )


def fault_of_pose(odom_pose: Float64, time_s: float) -> str:
    """Return why a scan's pose or time cannot be used; empty if it can."""
    if not np.isfinite(odom_pose).all() or not np.isfinite(time_s):
        return "its pose or time is not finite"
    turn, position = odom_pose[:3, :3], odom_pose[:3, 3]
    if np.abs(position).max() > FARTHEST_METERS:
        return (
            f"its pose is more than {FARTHEST_METERS:.0e} m from the origin. Check the odometry's "
            "unit"
        )
    if np.abs(turn @ turn.T - np.eye(3)).max() > NO_ROTATION or np.linalg.det(turn) < 0:
        return "its pose has no rotation: expected a (4, 4) rigid transform"
    return ""
