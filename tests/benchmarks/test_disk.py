"""Simulated disk that loses unsynced changes, and the log of its steps."""

import random
from pathlib import Path

import pytest

from benchmarks.durability.power_loss.disk import SECTOR, Disk, Keep, write_files
from benchmarks.durability.power_loss.disk_log import Step, steps_of

DRAW = random.Random(0)
ROOT = "/data"


def steps(*told: str) -> list[Step]:
    """Parse steps such as `write a hello 3`: kind, file, data and offset."""
    made = []
    for number, line in enumerate(told):
        kind, name, *more = line.split()
        to, offset, data = "", 0, b""
        if kind == "write":
            data, offset = more[0].encode(), int(more[1])
        elif kind == "cut":
            offset = int(more[0])
        elif kind == "rename":
            to = f"{ROOT}/{more[0]}"
        path = ROOT if name == "." else f"{ROOT}/{name}"
        made.append(Step(kind, number, number, path, to, offset, data))  # type: ignore[arg-type]
    return made


def left(keep: Keep, *told: str) -> dict[str, bytes]:
    """Return the files that a power cut leaves, by name."""
    disk = Disk(("-shm",))
    for step in steps(*told):
        disk.apply(step)
    found = disk.left(keep, DRAW)
    return {path.removeprefix(f"{ROOT}/"): content for path, content in found.items()}


def test_synced_write_is_kept() -> None:
    done = ("open a", "write a hello 0", "sync a", "sync .")
    for keep in ("nothing", "everything", "names", "data"):
        assert left(keep, *done) == {"a": b"hello"}


def test_unsynced_write_may_be_lost() -> None:
    done = ("open a", "write a hello 0", "sync a", "sync .", "write a J 0", "write a ! 7")
    assert left("nothing", *done) == left("names", *done) == {"a": b"hello"}
    assert left("everything", *done) == left("data", *done) == {"a": b"Jello\0\0!"}
    some = {left("some", *done)["a"] for _ in range(300)}
    assert some == {b"hello", b"Jello", b"hello\0\0!", b"Jello\0\0!"}


def test_name_is_kept_after_a_sync_of_its_folder() -> None:
    done = ("open a", "write a hello 0", "sync a")
    assert left("nothing", *done) == left("data", *done) == {}
    assert left("names", *done) == {"a": b"hello"}
    replaced = (*done, "sync .", "open b", "write b new 0", "rename b a")
    assert left("nothing", *replaced) == {"a": b"hello"}
    # The rename has reached the disk, but not the content of the file: it is empty.
    assert left("names", *replaced) == {"a": b""}
    assert left("everything", *replaced) == {"a": b"new"}
    assert left("nothing", *replaced, "sync b", "sync .") == {"a": b""}
    safe = (*replaced[:-1], "sync b", "rename b a")
    assert left("nothing", *safe) == {"a": b"hello"}
    assert left("names", *safe) == {"a": b"new"}
    assert left("nothing", *safe, "sync .") == {"a": b"new"}


def test_unsynced_removal_and_truncation_may_be_lost() -> None:
    done = ("open a", "write a hello 0", "sync a", "sync .", "cut a 2")
    assert left("nothing", *done) == {"a": b"hello"}
    assert left("data", *done) == {"a": b"he"}
    assert left("data", *done, "cut a 4") == {"a": b"he\0\0"}
    assert left("names", *done, "remove a") == {}
    assert left("nothing", *done, "remove a") == {"a": b"hello"}
    assert left("nothing", *done, "remove a", "sync .") == {}


def test_file_is_lost_with_its_folder() -> None:
    done = ("folder sub", "open sub/a", "write sub/a x 0", "sync sub/a", "sync sub")
    assert left("nothing", *done) == {}
    assert left("nothing", *done, "sync .") == {"sub/a": b"x"}


def test_shared_memory_is_not_kept() -> None:
    assert left("everything", "open a-shm", "write a-shm x 0") == {}


def test_write_during_a_sync_may_be_lost() -> None:
    disk = Disk()
    for step in [
        *(Step("open", 0, 0, "/data/a"), Step("sync", 1, 1, "/data")),
        Step("write", 2, 5, "/data/a", data=b"x"),
        Step("sync", 4, 6, "/data/a"),
    ]:
        disk.apply(step)
    assert disk.left("nothing", DRAW) == {"/data/a": b""}


def test_each_sector_of_a_write_may_be_kept_alone() -> None:
    disk = Disk()
    text = b"a" * SECTOR + b"b" * SECTOR
    for step in [
        *(Step("open", 0, 0, "/data/a"), Step("sync", 1, 1, "/data")),
        Step("write", 2, 2, "/data/a", offset=100, data=text),
    ]:
        disk.apply(step)
    assert disk.left("everything", DRAW)["/data/a"] == bytes(100) + text
    # Sectors begin at multiples of their size in the file, wherever the write begins.
    first, second, third = SECTOR - 100, 100, SECTOR - 100
    torn = bytes(100) + bytes(first) + b"a" * second + b"b" * third
    assert torn in {disk.left("some", DRAW)["/data/a"] for _ in range(2_000)}


def test_write_files_fills_another_folder(tmp_path: Path) -> None:
    write_files({"/data/a": b"1", "/data/sub/b": b"2"}, Path("/data"), tmp_path)
    assert (tmp_path / "a").read_bytes() == b"1"
    assert (tmp_path / "sub" / "b").read_bytes() == b"2"


def coded(text: str) -> str:
    return "".join(f"\\x{byte:02x}" for byte in text.encode())


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return (tmp_path / "data").resolve()


def test_log_of_strace_becomes_steps(tmp_path: Path, folder: Path) -> None:
    file, other = coded(f"{folder}/a"), coded("/elsewhere/a")
    answer = coded("HTTP/1.1 200 OK\r\nX-Request-Id: write-7\r\n\r\n")
    lines = [
        f'1 openat(AT_FDCWD<{coded("/")}>, "{file}", O_RDWR|O_CREAT|O_TRUNC, 0644) = 3<{file}>',
        f'1 openat(AT_FDCWD<{coded("/")}>, "{other}", O_RDWR|O_CREAT, 0644) = 4<{other}>',
        f'1 write(3<{file}>, "{coded("hello")}", 5) = 5',
        f'1 write(4<{other}>, "{coded("hello")}", 5) = 5',
        f'1 write(3<{file}>, "{coded("world")}", 5) = 3',
        f"2 fdatasync(3<{file}> <unfinished ...>",
        f'1 pwrite64(3<{file}>, "{coded("J")}", 1, 0) = 1',
        "2 <... fdatasync resumed>)                = 0",
        f"1 fsync(3<{file}>) = -1 EIO (Input/output error) (INJECTED)",
        f'1 sendto(9<{coded("socket:[12]")}>, "{answer}", 44, 0, NULL, 0) = 44',
        f"1 ftruncate(3<{file}>, 2) = 0",
        f'1 rename("{file}", "{coded(f"{folder}/b")}") = 0',
        f'1 unlink("{coded(f"{folder}/b")}") = 0',
        f'1 mkdir("{coded(f"{folder}/sub")}", 0777) = 0',
        f"1 fsync(3<{coded(str(folder))}>) = 0",
        f'1 write(3<{file}>, "{coded("lost")}", 4 <unfinished ...>',
        "1 +++ killed by SIGKILL +++",
    ]
    log = tmp_path / "log"
    log.write_text("\n".join(lines) + "\n")
    a, b = f"{folder}/a", f"{folder}/b"
    found = steps_of([log, log], folder)
    assert found[: len(found) // 2] == [
        Step("open", 0, 0, a),
        Step("cut", 0, 0, a),
        Step("write", 2, 2, a, data=b"hello"),
        Step("write", 4, 4, a, offset=5, data=b"wor"),
        Step("sync", 5, 7, a),
        Step("write", 6, 6, a, data=b"J"),
        Step("said", 9, 9, "socket:[12]", "write-7"),
        Step("cut", 10, 10, a, offset=2),
        Step("rename", 11, 11, a, b),
        Step("remove", 12, 12, b),
        Step("folder", 13, 13, f"{folder}/sub"),
        Step("sync", 14, 14, str(folder)),
    ]
    assert [step.begun for step in found[len(found) // 2 :]] == [
        15 + step.begun for step in found[: len(found) // 2]
    ]
