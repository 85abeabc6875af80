"""The client's scans, versions, exports and key at a real service."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from placecell_client import Client, ServiceError, encode

from placecell.descriptors.manifest import Manifest
from tests.service.clouds.scan_files import PILLARS, scan_file, yard_scan
from tests.service.service_builders import edit_of, map_of, random_codes


@pytest.fixture
def connected(service: Any) -> Callable[..., Client]:
    """Make clients of a service in this process."""

    def make(**options: Any) -> Client:
        return Client("http://testserver", transport=service._transport, **options)

    return make


@pytest.mark.parametrize("encoding", ["msgpack", "json"])
def test_scan_is_segmented_localized_and_stored(
    connected: Callable[..., Client], tmp_path: Path, encoding: str
) -> None:
    file = tmp_path / "scan.pcd"
    file.write_bytes(scan_file("pcd")[2])
    with connected(encoding=encoding) as client:
        scan = client.scan_file(file)
        assert (scan.format, scan.points, scan.problems) == ("PCD", len(yard_scan()), ())
        assert len(scan.segments) == len(scan.sensors) == len(PILLARS)
        np.testing.assert_allclose(
            scan.centroids, [each.mean(axis=0) for each in scan.segments], atol=2e-3
        )
        np.testing.assert_allclose(
            scan.extents, [np.ptp(each, axis=0) for each in scan.segments], atol=2e-3
        )
        assert scan.cloud.shape == (len(scan.labels), 3)
        np.testing.assert_array_equal(scan.transform, np.eye(4))
        assert scan.sensor_height == pytest.approx(1.8, abs=0.05)
        assert "5 segments" in repr(scan)
        assert len(client.describe(scan.segments, scan.sensors).codes) == len(PILLARS)
        added = client.add_scan("yard", str(file), robot="ann", position=[1, 2, 3], create=True)
        assert added.ids == tuple(range(len(PILLARS)))
        assert (added.written.changed, added.unusable) == (len(PILLARS), 0)
        assert client.version_changes("yard", 1).changed.frame_positions.tolist() == [[1, 2, 3]]


def test_versions_and_exports_are_read(
    connected: Callable[..., Client], manifest: Manifest
) -> None:
    with connected() as client:
        client.put_map("yard", encode(map_of(random_codes(9), manifest.model_id)))
        client.edit_map("yard", edit_of(random_codes(2, 1), manifest.model_id, first_id=500))
        changes = client.version_changes("yard", 2)
        assert (changes.since, changes.until) == (1, 2)
        assert changes.changed.ids.tolist() == [500, 501]
        dry = client.restore_map("yard", 1, dry_run=True)
        assert (dry.sequence, dry.changed, dry.removed) == (2, 0, 2)
        assert client.restore_map("yard", 1).sequence == 3
        file = client.export("yard", "ply", version=2)
        assert file.startswith(b"ply\n")
        assert b"element vertex 11\n" in file
        assert b"Feature" in client.export("yard", "geojson", anchor="49,8")
        scope = client.key()
        assert (scope.name, scope.role, scope.open) == ("anyone", "admin", True)
        with pytest.raises(ServiceError) as refused:
            client.export("yard", "exe")
        assert refused.value.status == 422
