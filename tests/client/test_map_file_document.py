"""The pages on map and delta files agree with the codec: examples, tables, program in C++."""

import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from placecell_client import CompactMap, Delta, decode, decode_delta, encode, encode_delta
from placecell_client.maps import container, delta_file, map_file
from placecell_client.maps.canonical import canonical
from placecell_client.maps.compact_map import OPTIONAL
from placecell_client.maps.edit import apply

from tests.client.file_surgery import compact_json, inner_header
from tests.client.map_builders import random_map

ROOT = Path(__file__).resolve().parents[2]
PAGES = [ROOT / "docs" / "reference" / f"{name}-file.md" for name in ("map", "delta")]
TEXT = "\n".join(page.read_text(encoding="utf-8") for page in PAGES)
LINE = r" {0,3}(\d+)  (?:ascii (.*)|([0-9a-f]{2}(?: [0-9a-f]{2})*)(?:  .*)?)"
EXAMPLE = CompactMap(
    model_id="m-1",
    preprocessing="1",
    frame="yard",
    codes=np.array([[1, -2], [3, 127]], np.int8),
    centroids=np.array([[1.0, 2.0, 3.0], [-4.0, 5.5, 0.25]]),
    ids=np.array([7, 3], np.uint32),
    robots=("bob", "ann"),
    robot=np.array([0, 1], np.uint16),
    frame_index=np.array([0, 0], np.uint32),
    frame_times=np.array([12.5]),
    frame_positions=np.array([[0.5, -2.0, 1.73]]),
    frame_orientations=np.array([[0, 0, 0, 1]], np.float32),
    points=np.array([812, 65_535], np.uint16),
)


def block(name: str) -> str:
    found = re.search(rf"```{name}\n(.*?)\n```\n", TEXT, re.DOTALL)
    assert found is not None
    return found[1]


def test_example_on_the_page_equals_the_codecs_bytes() -> None:
    data = b""
    for line in block("map").splitlines():
        parts = re.fullmatch(LINE, line)
        assert parts is not None, line
        assert int(parts[1]) == len(data), line
        data += parts[2].encode() if parts[2] else bytes.fromhex(parts[3])
    assert data == encode(EXAMPLE)
    assert f"\n{len(data)} bytes. " in TEXT


def test_delta_header_on_the_page_equals_the_codecs() -> None:
    data = encode_delta(Delta(EXAMPLE, np.array([4, 5, 9], np.uint32), 3, 5))
    assert block("delta").replace("\n", "") == compact_json(inner_header(data))


def test_moved_captures_on_the_page_equal_the_codecs_bytes() -> None:
    data = b""
    for line in block("moved").splitlines():
        parts = re.fullmatch(LINE.replace("{0,3}", "{0,4}"), line)
        assert parts is not None, line
        assert int(parts[1]) == len(data), line
        data += parts[2].encode() if parts[2] else bytes.fromhex(parts[3])
    before, delta = canonical(EXAMPLE), decode_delta(data)
    assert delta.moved is not None
    assert encode_delta(delta) == data
    after = apply(before, delta)
    assert after.centroids.tolist() == [[-6.96, -4.47, 0.25], [-2.2, -0.65, 3.0]]
    told = "segment 3 comes to -6.96, -4.47, 0.25 m, and segment 7 to -2.20, -0.65, 3.00 m"
    assert told in TEXT


def test_columns_on_the_page_equal_the_codecs() -> None:
    rows = re.findall(r"^\| `(\w+)` \| ([A-Z]\d+)(?:; (U\d+) if [^|]*)? \|", TEXT, re.MULTILINE)
    told = {name: tuple(filter(None, dtypes)) for name, *dtypes in rows}
    assert list(told.items()) == list(container.DTYPES.items())
    costs = dict(re.findall(r"^\| `(\w+)` \| (\d) \|", TEXT, re.MULTILINE))
    sizes = {
        name: np.dtype(dtype).itemsize * max(1, *shape, 1)
        for name, (dtype, shape) in OPTIONAL.items()
    }
    assert {name: int(cost) for name, cost in costs.items()} == sizes


def test_media_types_on_the_pages_equal_the_codecs() -> None:
    assert f"| map | `{map_file.MEDIA_TYPE}` |" in TEXT
    assert f"| delta | `{delta_file.MEDIA_TYPE}` |" in TEXT
    assert f"media type is `{delta_file.MEDIA_TYPE}`" in TEXT


@pytest.mark.skipif(shutil.which("g++") is None, reason="no g++ to build the program with")
def test_program_on_the_page_reads_map_files(tmp_path: Path) -> None:
    source, program = tmp_path / "read_map.cpp", tmp_path / "read_map"
    source.write_text(block("cpp"))
    subprocess.run(
        ["g++", "-std=c++17", "-Wall", "-Wextra", "-Werror", "-o", program, source], check=True
    )
    for given_map in (EXAMPLE, random_map(segments=50, optional=OPTIONAL, extent=1e7)):
        data = encode(given_map)
        back = decode(data)
        expected = "".join(
            f"{back.ids[row]} {back.robot[row]} {x:.2f} {y:.2f} {z:.2f} {back.codes[row, 0]}\n"
            for row, (x, y, z) in enumerate(back.centroids)
        )
        file = tmp_path / "a.map"
        file.write_bytes(data)
        assert subprocess.check_output([program, file], text=True) == expected
        for length in (0, 7, 100, len(data) - 1):
            file.write_bytes(data[:length])
            done = subprocess.run(
                [program, file], capture_output=True, text=True, timeout=60, check=False
            )
            assert (done.returncode, done.stdout) == (1, ""), length
