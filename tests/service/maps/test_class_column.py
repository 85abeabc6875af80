"""The column `classes` through the store: kept byte by byte, in each version and each delta."""

from dataclasses import replace
from typing import Any

import numpy as np
from placecell_client import Client, CompactMap, Delta, Description, MapCopy, decode, encode
from placecell_client.maps.edit import apply, take

from placecell.core.types import UInt8
from placecell.descriptors.manifest import Manifest
from tests.service.search.test_localize import seen_in, street_map

CLASSES = (np.arange(200) % 249).astype(np.uint8)
NONE = np.zeros(0, np.uint32)


def sorted_classes(content: CompactMap) -> UInt8:
    """Return the classes of the segments in the order of their ids."""
    assert content.classes is not None
    return content.classes[np.argsort(content.ids)]


def test_classes_survive_edits_deltas_restores_and_merges(service: Any, manifest: Manifest) -> None:
    client = Client("http://testserver", transport=service._transport)
    whole = replace(street_map(manifest), classes=CLASSES)
    client.put_map("street", whole)
    first = client.get_map("street")
    assert encode(first) == encode(whole)
    copy = client.pull(MapCopy("street"))
    # An edit changes a class alone, another adds segments without classes.
    changed = replace(take(whole, np.arange(3)), classes=np.array([248, 0, 121], np.uint8))
    client.edit_map("street", Delta(changed, NONE))
    bare = replace(take(street_map(manifest, 1), np.arange(2)), ids=np.array([900, 901], np.uint32))
    client.edit_map("street", Delta(bare, NONE))
    expected = apply(apply(whole, Delta(changed, NONE)), Delta(bare, NONE))
    assert encode(client.get_map("street")) == encode(expected)
    copy = client.pull(copy)
    assert copy.content is not None
    assert encode(copy.content) == encode(expected)
    assert encode(client.version_changes("street", 2).changed) == encode(changed)
    client.restore_map("street", 1)
    assert encode(client.get_map("street")) == encode(whole)
    client.put_map("twin", replace(whole, classes=np.full(200, 248, np.uint8)))
    assert client.merge_maps("site", ["street", "twin"]).segments
    joined = client.get_map("site")
    assert joined.classes is not None
    assert joined.source is not None
    assert joined.source_ids is not None
    own = joined.source == joined.sources.index("street") + 1
    before = sorted_classes(whole)[np.searchsorted(np.sort(whole.ids), joined.source_ids[own])]
    kept = joined.classes[own] == before
    assert (kept | (joined.classes[own] == 248)).all()
    assert kept.any()


def test_map_states_its_number_of_segments_of_each_class(service: Any, manifest: Manifest) -> None:
    client = Client("http://testserver", transport=service._transport)
    client.put_map("bare", street_map(manifest))
    classes = np.zeros(200, np.uint8)
    classes[:3], classes[3:5] = 31, 121
    client.put_map("street", replace(street_map(manifest), classes=classes))
    bare, street = client.maps().maps
    assert bare.classes == {}
    assert street.classes == {"building": 3, "vehicle": 2, "unknown": 195}
    detail = service.get("/maps/street", headers={"Accept": "application/json"}).json()
    assert detail["classes"] == street.classes


def test_client_filters_with_the_classes_of_its_description(
    service: Any, manifest: Manifest
) -> None:
    stored = street_map(manifest)
    classes = np.ones(200, np.uint8)
    classes[20:] = 121
    codes, centroids = seen_in(stored)
    for encoding in ("msgpack", "json"):
        client = Client("http://testserver", transport=service._transport, encoding=encoding)
        client.put_map("street", replace(stored, classes=classes))
        seen = Description(
            manifest.model_id, codes, np.zeros((40, 7), np.float32), centroids, {},
            classes=classes[:40],
        )  # fmt: skip
        found = client.match(seen, k=1, ignore="movable")
        assert sorted(found.errors) == list(range(20, 40))
        assert [each[0].id for each in found.queries[:20]] == list(range(100, 120))
        only = client.match(seen, k=1, classes=["vehicle"])
        assert sorted(only.errors) == list(range(20))
        best = client.localize(seen, ignore=["movable"]).maps[0]
        assert best.pose is not None
        assert {int(row) for row in best.inliers.ids} == set(range(100, 120))
    assert decode(encode(client.get_map("street"))).classes is not None
