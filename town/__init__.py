"""Synthetic town with a simulated LiDAR: drives for demos, tests and training.

Seeds determine everything: one the town, a second the parked cars, a third the sensor noise. The
same seeds give the same files, byte for byte.

    two_robots(Path("out/town"))

writes two drives along the same streets in opposite directions, in the KITTI odometry layout.

    town = Town.build(seed=7)
    route = Route.wander(town.plan, town.terrain, length=400.0)
    write_drive(Path("out/drive"), town, route, traffic_seed=1, scans=350)

writes one drive. The sensor is an HDL-64E; `lidar=sensor("vlp-16")` selects another one. A large
town has tens of kilometers of streets. Only the part near the sensor is built:

    city = City.build(seed=7, meters=20_000.0)
    route = city.route(city.planner.every_street())
    several_robots(Path("out/city"), city, route, robots=2)

Frames: the *town frame* (x and y level, z up); a drive's *world frame* (`origin.txt` has its
transform to the town frame); the *sensor frame* (x ahead, y left, z up).
"""

from town.city import City
from town.drives.drive import ORIGIN_FILE, read_origin, write_drive
from town.drives.pair import StretchPair
from town.drives.pairs import draw_pairs
from town.drives.robots import one_robot, several_robots, two_robots, way_of
from town.drives.traversal import Traversal
from town.geometry.mesh import Mesh
from town.geometry.scene import Scene
from town.objects.block import SceneObject
from town.sensing.lidar import HDL_64E, Lidar
from town.sensing.odometry import ODOMETRY_FILE, Odometry
from town.sensing.sensors import SENSORS, sensor
from town.streets.planner import Planner
from town.streets.route import Route
from town.town import Town

__all__ = [
    "HDL_64E",
    "ODOMETRY_FILE",
    "ORIGIN_FILE",
    "SENSORS",
    "City",
    "Lidar",
    "Mesh",
    "Odometry",
    "Planner",
    "Route",
    "Scene",
    "SceneObject",
    "StretchPair",
    "Town",
    "Traversal",
    "draw_pairs",
    "one_robot",
    "read_origin",
    "sensor",
    "several_robots",
    "two_robots",
    "way_of",
    "write_drive",
]
