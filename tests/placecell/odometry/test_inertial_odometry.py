"""Odometry from scans and an IMU: what RKO-LIO gets, and what it is refused for."""

from importlib import metadata
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from placecell.core.progress import silent
from placecell.core.types import Float64
from placecell.odometry import inertial_odometry, source_odometry
from placecell.odometry.inertial_odometry import imu_of, run_inertial
from placecell.odometry.scan_odometry import OdometrySettings, run
from placecell.odometry.source_odometry import odometry_of
from placecell.sources.errors import DriveError
from placecell.sources.imu import GRAVITY, ImuSamples
from placecell.sources.scan_options import RKO_LIO
from tests.placecell.datasets.source_fakes import MemorySource

STAMPS = [100.0, 100.1, 100.2, 100.3]
SWEEP = np.array([[5.0, 0, 0], [0, 5.0, 0], [0, 0, 5.0]])
TIMES = np.array([0.0, 0.05, 0.099])
SETTINGS = OdometrySettings(50.0, 1.0, 0.5, True)


class Inertial(MemorySource):
    """A source with an IMU of 100 Hz."""

    measured = True

    def imu(self, first: float, last: float) -> ImuSamples | None:
        if not self.measured:
            return None
        stamps = np.arange(first, last, 0.01)
        mount = np.eye(4)
        mount[:3, 3] = [0.1, 0, -0.2]
        forces = np.tile([0.0, 0.0, GRAVITY], (len(stamps), 1))
        return ImuSamples("/imu", stamps, forces, 0 * forces, None, mount, "tf")


class RefusedError(Exception):
    """The error that the fake raises for a scan."""


class FakeLio:
    """Moves by 1 m a scan, refuses the second scan, and keeps what it gets."""

    def __init__(self) -> None:
        self.imu: list[int] = []
        self.scans: list[NDArray[np.int64]] = []
        self.poses: list[tuple[int, Float64]] = []

    def add_imu_measurement(self, force: Float64, rate: Float64, time: int, mount: Float64) -> None:
        np.testing.assert_array_equal(force, [0, 0, GRAVITY])
        np.testing.assert_array_equal(mount[:3, 3], [0.1, 0, -0.2])
        self.imu.append(time)

    def register_scan(self, points: Float64, times: NDArray[np.int64]) -> None:
        self.scans.append(times)
        if len(self.scans) == 2:
            raise RefusedError
        self.poses.append((int(times.max()), np.array([len(self.scans) + 3.0, 0, 0, 0, 0, 0, 1])))

    def poses_with_timestamps(self) -> tuple[Any, Any]:
        return np.array([t for t, _ in self.poses]), np.array([pose for _, pose in self.poses])


def source(**more: Any) -> Inertial:
    return Inertial([SWEEP] * 4, STAMPS, **more)


def test_scans_and_measurements_are_fed_in_order_of_time(monkeypatch: pytest.MonkeyPatch) -> None:
    fake = FakeLio()
    monkeypatch.setattr(inertial_odometry, "rko_lio", lambda _: (fake, RefusedError))
    drive = source(times=[TIMES] * 4)
    poses = run_inertial(drive, SETTINGS, imu_of(drive), silent)
    assert [len(times) for times in fake.scans] == [3] * 4
    np.testing.assert_allclose(np.diff(fake.scans[0]) * 1e-9, np.diff(TIMES), atol=1e-8)
    np.testing.assert_allclose(np.diff([times[0] for times in fake.scans]) * 1e-9, 0.1, atol=1e-6)
    assert fake.imu == sorted(fake.imu)
    assert fake.imu[-1] <= fake.scans[-1].max()
    # The pose of a scan is that at its stamp, not at its end; the refused one lies between.
    np.testing.assert_allclose(poses[:, 0, 3], [0, 1, 2, 3], atol=1e-6)


def test_scans_that_are_all_refused_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    fake = FakeLio()
    fake.register_scan = lambda *_: (_ for _ in ()).throw(RefusedError)  # type: ignore[method-assign]
    monkeypatch.setattr(inertial_odometry, "rko_lio", lambda _: (fake, RefusedError))
    with pytest.raises(DriveError, match="rko-lio registered 0 of 4 scans"):
        run_inertial(source(), SETTINGS, imu_of(source()), silent)


def test_missing_package_is_named_with_the_command_that_installs_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def none(name: str) -> str:
        raise metadata.PackageNotFoundError(name)

    monkeypatch.setattr(metadata, "version", none)
    with pytest.raises(DriveError, match=r'pip install "placecell\[rko-lio\]"'):
        odometry_of(source(), True, silent, print, RKO_LIO)


def test_source_without_imu_or_times_is_refused() -> None:
    still = source()
    still.measured = False
    with pytest.raises(DriveError, match="needs an IMU, and there is no sensor_msgs/Imu"):
        imu_of(still)
    with pytest.raises(DriveError, match="needs scans with ascending times"):
        imu_of(Inertial([SWEEP] * 2, [1.0, 1.0]))


def test_drift_is_not_estimated_and_that_is_told(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Any
) -> None:
    monkeypatch.setenv("PLACECELL_CACHE", str(tmp_path))
    monkeypatch.setattr(metadata, "version", lambda _: "0.4.0")
    monkeypatch.setattr(source_odometry, "run_inertial", lambda *_: np.tile(np.eye(4), (4, 1, 1)))
    said: list[str] = []
    found = odometry_of(source(), True, silent, said.append, RKO_LIO)
    assert found.drift_percent is None
    assert any("odometry by rko-lio 0.4.0" in line for line in said)
    assert any("the drift of rko-lio is not estimated" in line for line in said)


def test_rko_lio_follows_a_sensor_that_stands() -> None:
    pytest.importorskip("rko_lio", reason="the extra rko-lio is not installed")
    draw = np.random.default_rng(0)
    room = draw.uniform(-10, 10, (4000, 3))
    room[np.arange(4000), draw.integers(0, 3, 4000)] = draw.choice([-10.0, 10.0], 4000)
    stamps = [100.0 + 0.1 * step for step in range(10)]
    drive = Inertial([room] * 10, stamps)
    poses = run_inertial(drive, SETTINGS, imu_of(drive), silent)
    np.testing.assert_allclose(poses, np.tile(np.eye(4), (10, 1, 1)), atol=0.02)


MOUNT = np.array([0.1, 0.0, -0.2])


def driven(times: Float64) -> tuple[Float64, Float64]:
    """Return positions (n, 3) and yaws (n,) of a sensor that stands, then drives a curve."""
    since = np.maximum(times - 101.0, 0.0)
    along = np.where(since < 2, since**2 / 2, 2 * since - 2)  # 1 m/s^2 for 2 s, then 2 m/s
    yaw = 0.25 * np.where(since < 2, since**2 / 4, since - 1)  # up to 0.25 rad/s
    steps = np.diff(along, prepend=along[:1])
    ahead = np.stack([np.cos(yaw), np.sin(yaw), 0 * yaw], axis=1)
    return np.cumsum(steps[:, None] * ahead, axis=0), yaw


class Driven(Inertial):
    """A source whose IMU measures the motion of `driven`, with its lever arm."""

    def imu(self, first: float, last: float) -> ImuSamples:
        fine = np.arange(first - 0.02, last, 0.001)
        positions, yaw = driven(fine)
        turn = np.stack([np.cos(yaw), -np.sin(yaw), np.sin(yaw), np.cos(yaw)], axis=1)
        turn = turn.reshape(-1, 2, 2)
        positions[:, :2] += np.einsum("nij,j->ni", turn, MOUNT[:2])
        wide = 10  # Differences over 10 ms, centered.
        second = positions[2 * wide :] - 2 * positions[wide:-wide] + positions[: -2 * wide]
        forces = second / (0.001 * wide) ** 2
        turn = turn[wide:-wide]
        forces[:, :2] = np.einsum("nji,nj->ni", turn, forces[:, :2])
        forces[:, 2] += GRAVITY
        rates = np.zeros_like(forces)
        rates[:, 2] = (yaw[2 * wide :] - yaw[: -2 * wide]) / (0.002 * wide)
        mount = np.eye(4)
        mount[:3, 3] = MOUNT
        each = slice(None, None, 5)  # 200 Hz
        stamps = fine[wide:-wide][each]
        return ImuSamples("/imu", stamps, forces[each], rates[each], None, mount, "tf")


def sweep_in_hall(stamp: float) -> tuple[Float64, Float64]:
    """Return the points of a distorted sweep in a hall with pillars, and their times (n,)."""
    times = np.repeat(np.linspace(-0.05, 0.05, 720, endpoint=False), 40)
    azimuth = np.repeat(np.radians(np.arange(0, 360, 0.5)), 40)
    elevation = np.tile(np.radians(np.linspace(-25, 15, 40)), 720)
    fine = np.arange(101.0, stamp + 0.1, 0.001) if stamp > 101.0 else np.array([101.0])
    positions, yaws = driven(fine)
    at = np.clip(np.searchsorted(fine, stamp + times), 0, len(fine) - 1)
    position, heading = positions[at], yaws[at] + azimuth
    flat = np.cos(elevation)
    ray = np.stack([flat * np.cos(heading), flat * np.sin(heading), np.sin(elevation)], axis=1)
    low, high = np.array([-15.0, -12.0, -1.5]), np.array([25.0, 21.0, 6.0])
    wall = np.where(ray > 0, high, low)
    reach = np.full(ray.shape, np.inf)
    reach = np.divide(wall - position, ray, out=reach, where=ray != 0).min(axis=1)
    for x, y in ((5, 4), (-4, -5), (9, -6), (14, 9), (2, 12), (-9, 7), (18, -3), (8, 16)):
        off = np.array([x, y]) - position[:, :2]
        beside = np.abs(off[:, 0] * np.sin(heading) - off[:, 1] * np.cos(heading))
        before = off[:, 0] * np.cos(heading) + off[:, 1] * np.sin(heading)
        hit = (beside < 0.5) & (before > 0)
        depth = (before - np.sqrt(np.maximum(0.25 - beside**2, 0))) / flat
        reach = np.where(hit, np.minimum(reach, depth), reach)
    seen = np.stack([flat * np.cos(azimuth), flat * np.sin(azimuth), np.sin(elevation)], axis=1)
    return seen * reach[:, None], times


@pytest.mark.slow
def test_rko_lio_follows_a_sensor_that_drives() -> None:
    pytest.importorskip("rko_lio", reason="the extra rko-lio is not installed")
    stamps = [100.1 + 0.1 * step for step in range(80)]
    sweeps = [sweep_in_hall(stamp) for stamp in stamps]
    drive = Driven([points for points, _ in sweeps], stamps, times=[each for _, each in sweeps])
    fine = np.arange(101.0, 108.2, 0.001)
    positions, yaws = driven(fine)
    at = np.clip(np.searchsorted(fine, stamps), 0, len(fine) - 1)
    meters = np.linalg.norm(np.diff(positions, axis=0), axis=1).sum()
    assert meters > 10
    inertial = run_inertial(drive, SETTINGS, imu_of(drive), silent)
    scans_only = run(drive, range(80), SETTINGS, silent, "odometry")
    off, off_without = (
        np.linalg.norm(poses[:, :3, 3] - positions[at], axis=1).max()
        for poses in (inertial, scans_only)
    )
    # The measured acceleration tells the start better than the scans do.
    assert off < 0.03 * meters < off_without
    found = np.arctan2(inertial[:, 1, 0], inertial[:, 0, 0])
    np.testing.assert_allclose(found, yaws[at], atol=np.radians(1))
