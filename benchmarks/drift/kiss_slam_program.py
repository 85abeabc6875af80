"""Program that runs KISS-SLAM on scans from its standard input, in the peers' environment.

Input: for each scan, the number of its points as uint64, then its points, float32 (n, 3), meters,
deskewed. Output: an NPZ file with the poses, float64 (n, 4, 4), the number of loop closures, and
the seconds of the processing. All settings are those of the package, without deskewing.
"""

import sys
from pathlib import Path
from time import perf_counter
from typing import BinaryIO

import numpy as np
from kiss_slam.config.config import load_config
from kiss_slam.slam import KissSLAM


def run(scans: BinaryIO, output: Path) -> None:
    """Process all scans, and write the result as the program `kiss_slam_pipeline` does."""
    config = load_config(None)
    config.odometry.preprocessing.deskew = False
    slam = KissSLAM(config)
    seconds, total = 0.0, 0
    while header := scans.read(8):
        count = int(np.frombuffer(header, np.uint64)[0])
        points = np.frombuffer(scans.read(12 * count), np.float32).reshape(-1, 3)
        total += 1
        begun = perf_counter()
        slam.process_scan(points.astype(np.float64), np.zeros(0))
        seconds += perf_counter() - begun
    begun = perf_counter()
    slam.generate_new_node()
    slam.local_map_graph.erase_last_local_map()
    poses, _ = slam.fine_grained_optimization()
    seconds += perf_counter() - begun
    # The first pose is that before the first scan.
    poses = np.array(poses)[-total:]
    np.savez(output, poses=poses, closures=len(slam.get_closures()), seconds=seconds)


if __name__ == "__main__":
    run(sys.stdin.buffer, Path(sys.argv[1]))
