from pathlib import Path

import numpy as np
import pytest

from placecell.sources import DriveError
from placecell.sources.catalog import describe, is_source, open_source


def test_a_path_opens_as_the_source_that_recognizes_it(tmp_path: Path) -> None:
    np.save(tmp_path / "0.npy", np.ones((2, 3), np.float32))
    assert is_source(tmp_path)
    assert len(open_source(tmp_path)) == 1
    assert open_source(tmp_path / "0.npy").title == "0"


def test_an_unknown_path_is_told_with_what_was_found(tmp_path: Path) -> None:
    with pytest.raises(DriveError, match="absent: does not exist"):
        open_source(tmp_path / "absent")
    (tmp_path / "image.png").write_bytes(b"\x89PNG\r\n\x1a\nmore")
    (tmp_path / "folder").mkdir()
    assert not is_source(tmp_path)
    with pytest.raises(
        DriveError, match=r"found a folder with folder/, image\.png\. Expected a ROS 1 bag"
    ):
        open_source(tmp_path)
    with pytest.raises(DriveError, match=r"begins with b'.x89PNG"):
        open_source(tmp_path / "image.png")
    with pytest.raises(DriveError, match="found an empty folder"):
        open_source(tmp_path / "folder")
    for number in range(10):
        (tmp_path / "folder" / f"{number}.yaml").touch()
    assert describe(tmp_path / "folder").endswith("7.yaml and 2 more")
    assert describe(tmp_path / "folder" / "0.yaml") == "an empty file"
    assert describe(tmp_path / "absent") == "a file that cannot be read (No such file or directory)"
