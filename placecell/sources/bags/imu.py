"""IMU of a bag: sensor_msgs/Imu, in the axes of the LiDAR by tf."""

from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from placecell.core.types import Float64
from placecell.sources.bags.bag_poses import Extrinsic, clock_shift, extrinsic
from placecell.sources.bags.containers.bag import Bag
from placecell.sources.bags.containers.container import BagTopic
from placecell.sources.bags.transform_tree import TransformTree, read_transforms
from placecell.sources.bags.wire import Wire
from placecell.sources.errors import DriveError
from placecell.sources.imu import GRAVITY, ImuSamples

IMU = "sensor_msgs/Imu"
DOUBLES = 37
"""Values of a message: orientation 4, angular velocity 3, acceleration 3, a covariance 9 each."""
IN_G = 2.0
"""Median acceleration below which its unit is taken as g, m/s^2: Livox drivers write g."""
UNKNOWN = -1.0
"""First value of a covariance if the driver does not measure the quantity."""
MARGIN = 1.0
"""Time of recording before and after the wanted span that is read too, seconds."""


def read_imu(
    bag: Bag, sensor: str, times: tuple[Float64, Float64], span: tuple[float, float]
) -> ImuSamples | None:
    """Read the IMU of a bag; None if it has none of use.

    An IMU whose pose on the robot is known comes first, then the one with the most measurements.

    Args:
        bag: the bag.
        sensor: frame of the LiDAR.
        times: stamps and times of recording of the scans, float64 (scans,), seconds.
        span: first and last stamp that is needed, seconds.

    Raises:
        DriveError: the transforms form a loop.
    """
    topics = [topic for topic in bag.topics if topic.type == IMU and len(topic)]
    if not topics:
        return None
    tree = read_transforms(bag)
    found = [each for topic in topics if (each := of_topic(bag, topic, tree, sensor, times, span))]
    found.sort(key=lambda each: (not each[1].found, -len(each[0])))
    return found[0][0] if found else None


def of_topic(
    bag: Bag,
    topic: BagTopic,
    tree: TransformTree,
    sensor: str,
    times: tuple[Float64, Float64],
    span: tuple[float, float],
) -> tuple[ImuSamples, Extrinsic] | None:
    """Read the measurements of a topic in a span of time; None if none is of use."""
    scans, scans_recorded = times
    late = float(np.median(scans_recorded - scans))
    recorded = topic.times.astype(np.float64) * 1e-9
    first, last = (
        int(np.searchsorted(recorded, moment + late + margin))
        for moment, margin in zip(span, (-MARGIN, MARGIN), strict=True)
    )
    part = replace(topic, times=topic.times[first:last], places=topic.places[first:last])
    rows, stamps_ns, kept, frame = [], [], [], ""
    for index, data in enumerate(bag.contents(part)):
        try:
            wire = Wire(data or b"", topic.encoding, str(bag.path))
            stamp, frame = wire.header()
            rows.append(wire.doubles(DOUBLES))
        except DriveError:  # Others may be whole.
            continue
        stamps_ns.append(stamp)
        kept.append(first + index)
    if not rows:
        return None
    values = np.array(rows)
    stamps, recorded = np.array(stamps_ns, np.float64) * 1e-9, recorded[kept]
    if not stamps.all():
        stamps = recorded - late
    stamps = stamps + clock_shift(stamps, recorded, scans, scans_recorded)
    accelerations, rates = values[:, 25:28], values[:, 13:16]
    usable = np.isfinite(accelerations).all(axis=1) & np.isfinite(rates).all(axis=1)
    usable &= values[:, 28] != UNKNOWN
    stamps, order = np.unique(stamps[usable], return_index=True)
    if not len(stamps) or not accelerations[usable].any():
        return None
    mounted = extrinsic(tree, sensor, frame)
    turn = mounted.transform[:3, :3]
    accelerations = accelerations[usable][order]
    median = float(np.median(np.linalg.norm(accelerations, axis=1)))
    scale = GRAVITY if median < IN_G else 1.0
    ups = ups_of(values[usable][order])
    how = mounted.how if mounted.found else f"identity: no transform from {sensor!r} to {frame!r}"
    return ImuSamples(
        topic.name,
        stamps,
        scale * accelerations @ turn.T,
        rates[usable][order] @ turn.T,
        None if ups is None else ups @ turn.T,
        mounted.transform,
        how,
    ), mounted


def ups_of(values: Float64) -> Float64 | None:
    """Return up in the IMU's axes by its orientation, float64 (n, 3); None if it has none.

    Args:
        values: values of the messages, float64 (n, 37).
    """
    quaternions = values[:, :4]
    lengths = np.linalg.norm(quaternions, axis=1)
    known = (values[:, 4] != UNKNOWN) & np.isfinite(lengths) & (np.abs(lengths - 1) < 0.05)
    identity = np.abs(quaternions - [0, 0, 0, 1]).max() < 1e-12
    if not known.all() or identity:  # Drivers without a filter write zeros or the identity.
        return None
    return np.asarray(Rotation.from_quat(quaternions).inv().apply([0.0, 0.0, 1.0]))
