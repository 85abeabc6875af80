"""The doctor on damaged files of all kinds: a report, no trace, no hang.

`PLACECELL_DOCTOR_MUTATIONS` is the number of damaged files of each kind; 10 by default.
"""

import json
import os
from pathlib import Path

import pytest

from placecell.inspection.inspect import inspect_source
from tests.placecell.sources.bags import test_mutated_bags as bags
from tests.placecell.sources.clouds.test_mutations import SEEDS
from tests.placecell.sources.mutations import MEMORY, Hang, bounded, mutated

COUNT = int(os.environ.get("PLACECELL_DOCTOR_MUTATIONS", "10"))
TRAJECTORIES = {
    "poses.txt": "".join(f"1 0 0 {step} 0 1 0 0 0 0 1 0\n" for step in range(20)),
    "poses.tum": "".join(f"17000000{step}.5 {step} 0 0 0 0 0 1\n" for step in range(10, 30)),
    "poses.csv": "time,x,y,z,qx,qy,qz,qw\n"
    + "".join(f"{step / 10},{step},0,0,0,0,0,1\n" for step in range(20)),
    "poses.g2o": "".join(f"VERTEX_SE3:QUAT {step} {step} 0 0 0 0 0 1\n" for step in range(20)),
}


def check(name: str, file: Path, content: bytes) -> None:
    """Inspect damaged copies of a file."""
    for seed in range(COUNT):
        file.write_bytes(mutated(content, seed))
        try:
            with bounded(4 * MEMORY + 20 * len(content)):
                found = inspect_source(file, 3).as_dict()
        except (Exception, Hang) as error:
            raise AssertionError(f"{name}, seed {seed}: {error!r}") from error
        json.dumps(found, allow_nan=False)
        for problem in found["problems"]:
            assert problem["what"], f"{name}, seed {seed}"
            assert problem["cure"], f"{name}, seed {seed}: {problem}"
        assert found["usable"] or found["problems"]


@pytest.mark.slow
@pytest.mark.parametrize("name", bags.FORMATS)
def test_damaged_bag_gives_a_report(name: str, tmp_path: Path) -> None:
    encoding, write = bags.FORMATS[name]
    content = write(tmp_path / name, bags.messages(encoding)).read_bytes()
    check(name, tmp_path / f"mutated{Path(name).suffix}", content)


@pytest.mark.slow
@pytest.mark.parametrize("kind", SEEDS)
def test_damaged_cloud_gives_a_report(kind: str, tmp_path: Path) -> None:
    for number, (suffix, content) in enumerate(SEEDS[kind]):
        check(f"{kind} {number}", tmp_path / f"cloud{suffix}", content)


@pytest.mark.slow
@pytest.mark.parametrize("name", TRAJECTORIES)
def test_damaged_trajectory_gives_a_report(name: str, tmp_path: Path) -> None:
    check(name, tmp_path / name, TRAJECTORIES[name].encode())
