"""Results of the demo if the service refuses to merge the maps."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import pytest
from placecell_client import Client, ServiceError

from demo.meeting import localize_and_merge
from evaluation.poses.queries import Pair
from service.engine import Engine
from tests.benchmarks.drive_builders import trip
from tests.service.service_builders import write_eigenvalue_model


class Refusing:
    """Service that refuses to merge, and gives the reason in a dry run."""

    def __init__(self, engine: Engine, kind: str) -> None:
        self.describe, self.info = engine.describe, engine.info
        self.kind = kind

    def put_map(self, name: str, data: bytes) -> None:
        assert (name, len(data) > 0) == ("b", True)

    def merge_maps(self, site: str, maps: list[str], *, dry_run: bool = False) -> Any:
        assert (site, maps) == ("site", ["a", "b"])
        if dry_run:
            return SimpleNamespace(alignments=(SimpleNamespace(detail="They lie apart."),))
        raise ServiceError(409, "no", "nothing was changed", f"urn:placecell:problem:{self.kind}")


def meeting(folder: Path, kind: str) -> Any:
    write_eigenvalue_model(folder / "models")
    for name in ("a", "b"):
        trip(folder / name, 3, left=range(0))
    pair = Pair.of(folder / "a", folder / "b")
    with Engine.temporary(folder / "models" / "tiny") as engine:
        return localize_and_merge(
            pair.mapper, pair.asker, cast(Client, Refusing(engine, kind)), "a", []
        )


def test_maps_that_cannot_be_aligned_are_reported_with_the_reason(tmp_path: Path) -> None:
    met = meeting(tmp_path, "not-aligned")
    assert (met.alignment, met.refusal) == (None, "They lie apart.")
    assert not met.is_merged
    assert not met.is_localized


def test_other_service_error_is_raised(tmp_path: Path) -> None:
    with pytest.raises(ServiceError):
        meeting(tmp_path, "other-model")
