"""Available cores of a process by its control groups and affinity."""

from pathlib import Path
from typing import Any

import pytest

from placecell.core import processors
from placecell.core.processors import available_cores, limit_threads

V2 = "31 23 0:28 {mounted} /sys/fs/cgroup rw - cgroup2 cgroup rw\n"
V1 = "32 31 0:29 {mounted} /sys/fs/cgroup/cpu,cpuacct rw shared:9 - cgroup cgroup rw,cpu,cpuacct\n"


@pytest.fixture(autouse=True)
def _host_of_64_cores(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(processors, "visible_cores", lambda: 64)


def host(root: Path, groups: str, mounts: str, files: dict[str, str]) -> Path:
    """Write a host's files below a folder."""
    for name, content in {
        "proc/self/cgroup": groups,
        "proc/self/mountinfo": mounts,
        **{f"sys/fs/cgroup/{name}": content for name, content in files.items()},
    }.items():
        file = root / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(content)
    return root


CONTAINER = "/kubepods/pod1/c2"


@pytest.mark.parametrize(
    ("groups", "mounts", "files", "expected"),
    [
        pytest.param("0::/\n", V2.format(mounted="/"), {"cpu.max": "200000 100000"}, 2, id="v2"),
        pytest.param("0::/\n", V2.format(mounted="/"), {"cpu.max": "max 100000"}, 64, id="v2-none"),
        pytest.param("0::/\n", V2.format(mounted="/"), {"cpu.max": "150000 100000"}, 2, id="part"),
        pytest.param("0::/\n", V2.format(mounted="/"), {"cpu.max": "10000 100000"}, 1, id="tenth"),
        pytest.param(
            "0::/a/b\n",
            V2.format(mounted="/"),
            {"a/cpu.max": "300000 100000", "a/b/cpu.max": "max 100000"},
            3,
            id="v2-of-a-group-above",
        ),
        pytest.param(
            f"0::{CONTAINER}\n",
            V2.format(mounted=CONTAINER),
            {"cpu.max": "200000 100000"},
            2,
            id="v2-without-a-namespace",
        ),
        pytest.param(
            "0::/../other\n",
            V2.format(mounted="/"),
            {"cpu.max": "200000 100000"},
            2,
            id="v2-outside-of-the-namespace",
        ),
        pytest.param(
            f"5:cpu,cpuacct:{CONTAINER}\n0::/\n",
            V1.format(mounted=CONTAINER),
            {
                "cpu,cpuacct/cpu.cfs_quota_us": "200000\n",
                "cpu,cpuacct/cpu.cfs_period_us": "100000\n",
            },
            2,
            id="v1",
        ),
        pytest.param(
            "5:cpu,cpuacct:/a\n",
            V1.format(mounted="/"),
            {"cpu,cpuacct/a/cpu.cfs_quota_us": "-1", "cpu,cpuacct/a/cpu.cfs_period_us": "100000"},
            64,
            id="v1-none",
        ),
        pytest.param("garbage\n::\n", "a b\n - \n", {}, 64, id="garbage"),
        pytest.param("0::/\n", V2.format(mounted="/"), {"cpu.max": "1 0"}, 64, id="period-0"),
    ],
)
def test_B14_quota_of_the_control_group_limits_the_cores(
    tmp_path: Path, groups: str, mounts: str, files: dict[str, str], expected: int
) -> None:
    assert available_cores(host(tmp_path, groups, mounts, files)) == expected


def test_B14_host_without_control_groups_has_the_cores_of_its_affinity(tmp_path: Path) -> None:
    assert available_cores(tmp_path) == 64


def test_B14_affinity_is_below_the_quota(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(processors, "visible_cores", lambda: 1)
    root = host(tmp_path, "0::/\n", V2.format(mounted="/"), {"cpu.max": "200000 100000"})
    assert available_cores(root) == 1


def test_B14_numeric_libraries_are_told_the_quota(tmp_path: Path) -> None:
    root = host(tmp_path, "0::/\n", V2.format(mounted="/"), {"cpu.max": "200000 100000"})
    environment = {"MKL_NUM_THREADS": "1"}
    limit_threads(root, environment)
    assert environment == {
        "OMP_NUM_THREADS": "2",
        "OPENBLAS_NUM_THREADS": "2",
        "MKL_NUM_THREADS": "1",
        "NUMBA_NUM_THREADS": "2",
    }


@pytest.mark.parametrize("environment", [{"OMP_NUM_THREADS": "1"}, {}])
def test_B14_environment_stays_without_need(tmp_path: Path, environment: dict[str, str]) -> None:
    before = dict(environment)
    root = tmp_path
    if environment:
        root = host(tmp_path, "0::/\n", V2.format(mounted="/"), {"cpu.max": "200000 100000"})
    limit_threads(root, environment)
    assert environment == before


def test_B14_extractor_has_a_session_for_each_available_core(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from placecell.descriptors import extractor
    from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER

    made: list[Path] = []
    monkeypatch.setattr(extractor, "available_cores", lambda: 2)
    one_thread_session = extractor.one_thread_session

    def counted(file: Path) -> Any:
        made.append(file)
        return one_thread_session(file)

    monkeypatch.setattr(extractor, "one_thread_session", counted)
    extractor.load_extractor(MODELS_FOLDER / DEFAULT_MODEL)
    assert len(made) == 2
