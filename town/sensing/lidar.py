"""Simulated spinning LiDAR; its defaults are those of the Velodyne HDL-64E of KITTI.

Sensor frame: x ahead, y left, z up, meters; the origin is where the beams meet.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from placecell.core.types import Float32, Float64, Int32
from town.geometry.scene import Surfaces

SWEEP_SECONDS = 0.1
"""Duration of a sweep, seconds: all sensors are simulated at 10 Hz."""


def hdl_64e_elevations() -> tuple[float, ...]:
    """Return the elevations of the 64 beams, degrees: 32 in steps of 1/3, 32 in steps of 1/2."""
    upper = np.linspace(2.0, -8.33, 32)
    lower = np.linspace(-8.83, -24.33, 32)
    return tuple(float(angle) for angle in np.concatenate([upper, lower]))


@dataclass(frozen=True, slots=True)
class Lidar:
    """Sensor that sweeps its beams once around, clockwise, beginning behind the robot.

    The sensor moves during the sweep: each column is fired from the position at its time. `scan`
    deskews the points with the true motion (KITTI: with the measured motion); they are in the
    sensor frame at the middle of the sweep. `raw_scan` leaves them as measured, with their times.

    Attributes:
        columns: number of azimuth steps per revolution.
        elevations: elevation of each beam, degrees above the horizon.
        height: height of the sensor above the ground, meters.
        range_noise: standard deviation of the range, meters.
        resolution: step of the range, meters.
        dropout: share of the returns that are lost.
        min_range: smallest range of a return, meters.
        max_range: largest range of a return, meters.
        range_at_tenth: largest range at which a surface of reflectance 0.1 is seen, meters. The
            intensity decreases with the square of the range, so darker surfaces vanish earlier.
        rain: rain rate, millimeters per hour (2 is light, 10 heavy). Rain reduces the intensity, so
            far and dark surfaces vanish (Goodin et al. 2019, *Predicting the Influence of Rain on
            LIDAR in ADAS*).
    """

    columns: int = 1000
    elevations: tuple[float, ...] = hdl_64e_elevations()
    height: float = 1.73
    range_noise: float = 0.02
    resolution: float = 0.002
    dropout: float = 0.02
    min_range: float = 0.9
    max_range: float = 100.0
    range_at_tenth: float = 50.0
    rain: float = 0.0

    def sweep_times(self) -> Float64:
        """Return each column's time, (columns,), in revolutions from the middle of the sweep."""
        return (np.arange(self.columns) + 0.5) / self.columns - 0.5

    def directions(self, time: float = 0.0) -> Float32:  # noqa: ARG002
        """Return the beam directions of a sweep: unit vectors, sensor frame.

        Args:
            time: time of the middle of the sweep, seconds; a spinning sensor repeats its pattern.

        Returns:
            float32 (columns, beams, 3).
        """
        azimuth = -2 * np.pi * self.sweep_times()[:, None]
        elevation = np.radians(self.elevations)[None, :]
        ahead = np.cos(elevation) * np.cos(azimuth)
        left = np.cos(elevation) * np.sin(azimuth)
        up = np.broadcast_to(np.sin(elevation), ahead.shape)
        return np.stack([ahead, left, up], axis=-1).astype(np.float32)

    def scan(
        self,
        scene: Surfaces,
        sweep: Float64,
        pose: Float64,
        rng: np.random.Generator,
        time: float = 0.0,
    ) -> Float32:
        """Simulate one sweep and deskew it with the true motion.

        Args:
            scene: surfaces in range.
            sweep: (columns, 4, 4), sensor to town at each column's time.
            pose: (4, 4), sensor to town at the middle of the sweep.
            rng: random number generator of the noise.
            time: time of the middle of the sweep, seconds.

        Returns:
            float32 (n, 4), x, y, z in the sensor frame of `pose`, meters, and reflectance, 0 to 1.
        """
        return self.scan_and_hits(scene, sweep, pose, rng, time)[0]

    def scan_and_hits(
        self,
        scene: Surfaces,
        sweep: Float64,
        pose: Float64,
        rng: np.random.Generator,
        time: float = 0.0,
    ) -> tuple[Float32, Int32]:
        """Return the points of `scan`, and the triangle that each of them lies on, int32 (n,)."""
        directions = self.directions(time)
        kept, measured, hit = self._returns(scene, sweep, directions, rng)
        relative = np.linalg.inv(pose) @ sweep
        turned = np.matmul(directions, relative[:, :3, :3].astype(np.float32).transpose(0, 2, 1))
        column = kept // len(self.elevations)
        points = np.empty((len(column), 4), dtype=np.float32)
        points[:, :3] = turned.reshape(-1, 3)[kept] * measured[:, None]
        points[:, :3] += relative[column, :3, 3].astype(np.float32)
        points[:, 3] = scene.reflectance[hit]
        return points, hit

    def raw_scan(
        self, scene: Surfaces, sweep: Float64, rng: np.random.Generator, time: float = 0.0
    ) -> Float32:
        """Simulate one sweep without deskewing: the points are distorted by the motion.

        With the same arguments, `scan` returns the same points deskewed, in the same order.

        Args:
            scene: surfaces in range.
            sweep: (columns, 4, 4), sensor to town at each column's time.
            rng: random number generator of the noise.
            time: time of the middle of the sweep, seconds.

        Returns:
            float32 (n, 5): x, y, z in the sensor frame at the time of the point, meters;
            reflectance, 0 to 1; time of the point from the middle of the sweep, seconds.
        """
        return self.raw_scan_and_hits(scene, sweep, rng, time)[0]

    def raw_scan_and_hits(
        self, scene: Surfaces, sweep: Float64, rng: np.random.Generator, time: float = 0.0
    ) -> tuple[Float32, Int32]:
        """Return the points of `raw_scan`, and the triangle that each lies on, int32 (n,)."""
        directions = self.directions(time)
        kept, measured, hit = self._returns(scene, sweep, directions, rng)
        points = np.empty((len(kept), 5), dtype=np.float32)
        points[:, :3] = directions.reshape(-1, 3)[kept] * measured[:, None]
        points[:, 3] = scene.reflectance[hit]
        points[:, 4] = SWEEP_SECONDS * self.sweep_times()[kept // len(self.elevations)]
        return points, hit

    def _returns(
        self, scene: Surfaces, sweep: Float64, directions: Float32, rng: np.random.Generator
    ) -> tuple[NDArray[np.intp], Float32, Int32]:
        """Return the rays that return, and the measured range and the triangle of each."""
        rotations = sweep[:, :3, :3].astype(np.float32)
        cast = np.matmul(directions, rotations.transpose(0, 2, 1))
        origins = np.broadcast_to(sweep[:, None, :3, 3].astype(np.float32), cast.shape)
        ranges, hit = scene.cast(
            np.ascontiguousarray(origins.reshape(-1, 3)), np.ascontiguousarray(cast.reshape(-1, 3))
        )
        noise = rng.standard_normal(len(ranges), dtype=np.float32) * np.float32(self.range_noise)
        kept = rng.random(len(ranges), dtype=np.float32) >= self.dropout
        reflectance = scene.reflectance[hit]
        measured = ranges + noise
        measured = np.round(measured / self.resolution) * np.float32(self.resolution)
        kept &= (hit >= 0) & (measured >= self.min_range) & (measured <= self.max_range)
        lost = np.float32(2 * 0.01 * self.rain**0.6) * np.minimum(
            ranges, np.float32(self.max_range)
        )
        bright = reflectance * np.exp(-lost)
        kept &= bright * np.float32(self.range_at_tenth**2) >= np.float32(0.1) * ranges**2
        rays = np.flatnonzero(kept)
        return rays, measured[rays].astype(np.float32, copy=False), hit[rays]


HDL_64E = Lidar()
