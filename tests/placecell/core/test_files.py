from pathlib import Path

import pytest

from placecell.core.files import lock_at_once, natural_key, written_whole


def test_names_sort_by_their_numbers() -> None:
    names = ["b2.pcd", "a10.pcd", "a9.pcd", "a9_b.pcd", "a009.pcd", "7.pcd", "A1.pcd"]
    ordered = [file.name for file in sorted(map(Path, names), key=natural_key)]
    assert ordered[:2] == ["7.pcd", "A1.pcd"]
    assert ordered[-2:] == ["a10.pcd", "b2.pcd"]


def test_file_appears_when_it_is_whole(tmp_path: Path) -> None:
    file = tmp_path / "folder" / "a.txt"
    with written_whole(file) as unfinished:
        unfinished.write_text("new")
        assert not file.exists()
    assert file.read_text() == "new"
    assert list(file.parent.iterdir()) == [file]


def test_error_keeps_the_old_file(tmp_path: Path) -> None:
    file = tmp_path / "a.txt"
    file.write_text("old")

    def write_half() -> None:
        with written_whole(file) as unfinished:
            unfinished.write_text("ne")
            raise ValueError("half")

    with pytest.raises(ValueError, match="half"):
        write_half()
    assert file.read_text() == "old"
    assert list(tmp_path.iterdir()) == [file]


def test_a_file_is_locked_once_until_it_is_closed(tmp_path: Path) -> None:
    file = tmp_path / "lock"
    with file.open("a") as first, file.open("a") as second:
        lock_at_once(first.fileno())
        with pytest.raises(BlockingIOError):
            lock_at_once(second.fileno())
        first.close()
        lock_at_once(second.fileno())
