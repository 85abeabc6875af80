"""Damaged files of each format give a result or a DriveError that names the file."""

import os
import time
from collections import Counter
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from placecell.sources import DriveError
from placecell.sources.clouds import FolderOfClouds
from tests.placecell.sources.clouds.mutations import mutate
from tests.placecell.sources.clouds.writers import las, pcd, ply

COUNT = int(os.environ.get("CLOUD_MUTATIONS", "200"))
"""Damaged files of each format; 10,000 by hand."""
LONGEST = 5.0
"""Longest time for a file of some kilobytes, seconds."""

RNG = np.random.default_rng(8)
CLOUD = np.round(RNG.normal(0, 20, (60, 3)), 2)
ROWS = [[x, y, z, index, index * 1_000_000] for index, (x, y, z) in enumerate(CLOUD)]
FIELDS = [
    ("x", "F", 4, 1), ("y", "F", 4, 1), ("z", "F", 4, 1), ("ring", "U", 2, 1), ("t", "U", 4, 1),
]  # fmt: skip
PROPERTIES = ["float x", "float y", "double z", "ushort ring", "uint t"]
LISTS = [[row[0], [1, 2, 3], *row[1:]] for row in ROWS]
FACES = "element face 2\nproperty list uchar int i"


def saved(save: Any, *arrays: Any, **named: Any) -> bytes:
    stream = BytesIO()
    save(stream, *arrays, **named)
    return stream.getvalue()


def table(delimiter: str, header: str = "") -> bytes:
    return (header + "".join(delimiter.join(map(str, row)) + "\n" for row in ROWS)).encode()


STRUCTURED = np.zeros(60, [("x", "<f4"), ("y", ">f8"), ("z", "<f4"), ("t", "<u8")])
STRUCTURED["x"], STRUCTURED["y"], STRUCTURED["z"] = CLOUD.T
STRUCTURED["t"] = 1_583_836_591_500_000_000 + np.arange(60) * 1_000_000
ARRAY = CLOUD.astype(np.float32)
SWEEP = RNG.normal(0, 1, (1500, 3)) * [20, 15, 1]

SEEDS: dict[str, list[tuple[str, bytes]]] = {
    "pcd": [(".pcd", pcd(FIELDS, ROWS, each)) for each in ("ascii", "binary", "binary_compressed")],
    "ply": [
        *((".ply", ply(f"binary_{each}_endian", PROPERTIES, ROWS)) for each in ("big", "little")),
        (".ply", ply("ascii", PROPERTIES, ROWS)),
        (".ply", ply("ascii", [PROPERTIES[0], "list uchar int v", *PROPERTIES[1:]], LISTS)),
        (
            ".ply",
            ply(
                "binary_little_endian",
                [PROPERTIES[0], "list uchar int v", *PROPERTIES[1:]],
                LISTS,
                before=FACES,
                before_body=bytes(2),
            ),
        ),
    ],
    "las": [
        (".las", las(CLOUD)),
        (".las", las(CLOUD, False, 4, 6)),
        (".laz", las(CLOUD, True)),
        (".laz", las(CLOUD, True, 4, 7)),
    ],
    "numpy": [
        (".npy", saved(np.save, ARRAY)),
        (".npy", saved(np.save, STRUCTURED)),
        (".npz", saved(np.savez, points=ARRAY, t=STRUCTURED["t"])),
        (".npz", saved(np.savez_compressed, points=ARRAY)),
    ],
    "text": [
        (".csv", table(",", "x,y,z,ring,t\n")),
        (".xyz", table(" ")),
        (".txt", table("\t", "// X Y Z ring t\n")),
        (".csv", table(";").replace(b".", b",")),
        (".pts", b"60\n" + table(" ")),
    ],
    "raw": [
        (".bin", np.insert(SWEEP, 3, np.arange(1500) % 7, axis=1).astype("<f4").tobytes()),
        (".bin", SWEEP.astype("<f4").tobytes()),
        (".bin", SWEEP.astype("<f8").tobytes()),
        (".bin", np.insert(ARRAY, 3, 0.5, axis=1).tobytes()),
    ],
}


def check(file: Path) -> str:
    """Read a file, check the result, and return how it ended."""
    refused = ""
    try:
        source = FolderOfClouds(file)
        scan = source.scan(0)
    except DriveError as error:
        refused = str(error)
    if refused:
        assert refused.startswith(f"{file}: ")
        assert refused.isprintable()
        assert len(refused) < 1500
        return "refused"
    assert scan.points.dtype == np.float32
    assert scan.points.shape[1] == 3
    assert np.isfinite(scan.points).all()
    assert len(scan.points) <= scan.read <= 64 * 2**20
    if scan.times is not None:
        assert scan.times.shape == (len(scan.points),)
        assert np.isfinite(scan.times).all()
    assert all(note.isprintable() for note in source.notes())
    return "read"


@pytest.mark.slow
@pytest.mark.parametrize("kind", list(SEEDS))
def test_damaged_files_are_read_or_refused(kind: str, tmp_path: Path) -> None:
    random = np.random.default_rng(list(kind.encode()))
    ends: Counter[str] = Counter()
    longest = 0.0
    for number in range(COUNT):
        suffix, content = SEEDS[kind][number % len(SEEDS[kind])]
        file = tmp_path / f"cloud{suffix}"
        file.write_bytes(mutate(content, random))
        started = time.perf_counter()
        try:
            ends[check(file)] += 1
        except BaseException:
            kept = tmp_path / f"failed{suffix}"
            kept.write_bytes(file.read_bytes())
            print(f"{kind}: mutation {number}, kept as {kept}")
            raise
        longest = max(longest, time.perf_counter() - started)
    print(f"{kind}: {dict(ends)}, the slowest in {longest:.2f} s")
    assert longest < LONGEST


@pytest.mark.parametrize("kind", list(SEEDS))
def test_undamaged_files_are_read(kind: str, tmp_path: Path) -> None:
    for suffix, content in SEEDS[kind]:
        file = tmp_path / f"cloud{suffix}"
        file.write_bytes(content)
        assert check(file) == "read"
        assert FolderOfClouds(file).scan(0).read >= 60
