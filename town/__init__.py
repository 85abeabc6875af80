"""A synthetic town with a simulated spinning LiDAR: drives for demos, tests and training.

Everything follows from seeds: the town from one, the parked cars from a second, the sensor's noise
from a third. The same seeds give the same files, byte for byte.

    two_robots(Path("out/town"))

writes two drives along the same streets in opposite directions, in the KITTI odometry layout.

    town = Town.build(seed=7)
    route = Route.wander(town, length=400.0)
    write_drive(Path("out/drive"), town, route, traffic_seed=1, scans=350)

writes one. Frames: the *town frame* (x, y level, z up); a drive's *world frame* (where
`origin.txt` takes it to the town frame); the *sensor frame* (x ahead, y left, z up).
"""

from town.block import SceneObject
from town.drive import read_origin, write_drive
from town.lidar import HDL_64E, Lidar
from town.mesh import Mesh
from town.robots import two_robots
from town.route import Route
from town.scene import Scene
from town.town import Town

__all__ = [
    "HDL_64E",
    "Lidar",
    "Mesh",
    "Route",
    "Scene",
    "SceneObject",
    "Town",
    "read_origin",
    "two_robots",
    "write_drive",
]
