"""Link through the HTTP client."""

import httpx
import numpy as np
from placecell_client import Client, MapCopy, ServiceError
from placecell_client.http.retry import Retries
from placecell_client.results.core import Description
from scipy.spatial.transform import Rotation

from robot.core.link import FixAnswer, FixRequest, LinkError, RefusedError
from robot.core.map_to_odom import MapToOdom
from robot.core.status import AgentStatus
from robot.localization.local_engine import FLOOR
from robot.localization.rigid import covariance_at_sensor

TEMPORARY = frozenset({408, 425, 429, 500, 502, 503, 504})
"""Statuses after which the same call may succeed."""
REASON = 200
"""Largest length of the reason in a report."""
ONE_ATTEMPT = Retries(attempts=1)
"""The agent spaces its calls itself, so that a scan's request is not repeated when it is old."""


def robot_client(url: str, key: str | None = None, timeout: float = 10.0) -> Client:
    """Return a client for a robot: it makes each call once, and gives up after some seconds."""
    return Client(url, timeout, key=key, retries=ONE_ATTEMPT)


class ServiceLink:
    """Calls to a Placecell service; threads may share it."""

    def __init__(self, client: Client, asking: Client | None = None) -> None:
        """Use clients, such as those of `robot_client`; the caller closes them.

        Args:
            client: client for transfers.
            asking: client for requests of the pose, with a shorter timeout; None: the same.
        """
        self._client = client
        self._asking = asking or client

    def localize(self, request: FixRequest) -> FixAnswer:
        """Request the pose of the robot.

        Raises:
            LinkError, RefusedError: there is no answer.
        """
        seen = Description(
            request.model_id,
            request.codes,
            np.zeros((len(request.codes), 0), np.float32),
            request.centroids,
            {},
            classes=request.classes,
            heights=request.heights,
        )
        ignore = request.ignore or None
        try:
            found = self._asking.localize(
                seen,
                maps=[request.map],
                session=request.session,
                hints=request.hints,
                ignore=ignore,
            )
        except (ServiceError, httpx.TransportError) as error:
            raise as_link_error(error) from error
        best = found.maps[0] if found.maps else None
        if best is None:
            skipped = ", ".join(each.model_id for each in found.skipped)
            reason = f"the service did not search the map (model {skipped or 'unknown'})"
            return FixAnswer(request, "service", None, None, 0.0, reason)
        if best.pose is None or best.covariance is None:
            reason = best.detail or str(best.reason)
            return FixAnswer(request, "service", None, None, best.probability, reason)
        transform = best.pose.matrix
        covariance = covariance_at_sensor(
            best.covariance, transform, request.odom_pose[:3, 3], FLOOR
        )
        return FixAnswer(request, "service", transform, covariance, best.probability, "")

    def upload(self, name: str, delta: bytes, robot: str, create: bool) -> None:
        """Store an edit of a robot in a map.

        Raises:
            LinkError, RefusedError: the edit may not be stored.
        """
        try:
            self._client.edit_map(name, delta, robot=robot, create=create, deduplicate=True)
        except (ServiceError, httpx.TransportError) as error:
            raise as_link_error(error) from error

    def pull(self, copy: MapCopy) -> MapCopy:
        """Update a copy of a map.

        Raises:
            LinkError, RefusedError: the copy keeps its version.
        """
        try:
            return self._client.pull(copy)
        except (ServiceError, httpx.TransportError) as error:
            raise as_link_error(error) from error

    def report(self, robot: str, status: AgentStatus, pose: MapToOdom | None) -> None:
        """Report the pose and the state of the robot.

        Raises:
            LinkError, RefusedError: the report was not taken.
        """
        found = {}
        if pose is not None:
            turn = Rotation.from_matrix(pose.transform[:3, :3]).as_quat()
            found = {
                "map_name": pose.map,
                "position": pose.transform[:3, 3],
                "orientation": turn,
                "covariance": pose.covariance,
            }
        try:
            self._client.report_pose(
                robot,
                **found,
                probability=status.last_fix.probability if status.last_fix else None,
                state=status.state.value,
                reason=status.reason[:REASON],
                time=status.time if status.time >= 0 else None,
            )
        except (ServiceError, httpx.TransportError) as error:
            raise as_link_error(error) from error

    def close(self) -> None:
        """Leave the client open: it belongs to the caller."""


def as_link_error(error: ServiceError | httpx.TransportError) -> LinkError | RefusedError:
    """Return the error that tells whether the call may succeed later."""
    if isinstance(error, httpx.TransportError):
        return LinkError(f"the service cannot be reached: {str(error) or type(error).__name__}")
    if error.status in TEMPORARY or 200 <= error.status < 300:
        return LinkError(str(error), error.retry_after, was_reached=True)
    return RefusedError(str(error), error.status, error.type.rpartition(":")[2])
