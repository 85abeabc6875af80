"""Judge: compares what the replicas have at the end with what was acknowledged."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import httpx
import numpy as np
from placecell_client import CompactMap, decode, encode
from placecell_client.maps.edit import take
from placecell_client.maps.union import union

QUERIES = 64
"""Number of segments of each map that the judge searches at each replica."""

SECONDS = 60.0


@dataclass(frozen=True, slots=True)
class ReplicaView:
    """Answers of one replica to the judge.

    Attributes:
        files: file of each map, by name.
        etags: ETag of each map, by name.
        matches: body of the answer to one `/match` in all maps.
    """

    files: dict[str, bytes]
    etags: dict[str, str]
    matches: bytes


def view_of(address: str, maps: Sequence[str], search: Mapping[str, Any]) -> ReplicaView:
    """Read all maps of a replica, and search them.

    Args:
        address: address of the replica itself.
        maps: names of the maps.
        search: body of the `/match`.
    """
    with httpx.Client(base_url=address, timeout=SECONDS) as http:
        answers = {name: http.get(f"/maps/{name}").raise_for_status() for name in maps}
        matches = http.post("/match", json=dict(search)).raise_for_status().content
    return ReplicaView(
        {name: answer.content for name, answer in answers.items()},
        {name: answer.headers["ETag"] for name, answer in answers.items()},
        matches,
    )


def search_in(maps: Mapping[str, CompactMap], model_id: str) -> dict[str, Any]:
    """Return the body of a `/match` of some segments of each map, in all maps."""
    codes = [
        code
        for content in maps.values()
        for code in content.codes[:: max(1, len(content) // QUERIES)].tolist()
    ]
    return {"model_id": model_id, "codes": codes[: 4 * QUERIES], "maps": [*maps], "k": 10}


def is_union(file: bytes, own: Sequence[CompactMap]) -> bool:
    """Return whether a file holds exactly the acknowledged segments of all writers."""
    return file == encode(union([each for each in own if len(each)]))


def lost_in(file: bytes, own: Sequence[CompactMap]) -> int:
    """Return the number of acknowledged segments that a file lacks or has with another content.

    A segment that was removed, and is there, counts too.
    """
    found, lost = decode(file), 0
    for given in own:
        if not len(given):
            continue
        each = decode(encode(given))  # in canonical form
        (robot,) = each.robots
        there = found.robots.index(robot) if robot in found.robots else -1
        mine = take(found, found.robot == there)
        both, here, over_there = np.intersect1d(each.ids, mine.ids, return_indices=True)
        same = (each.codes[here] == mine.codes[over_there]).all(axis=1)
        same &= (each.centroids[here] == mine.centroids[over_there]).all(axis=1)
        lost += len(each) + len(mine) - 2 * len(both) + int(np.count_nonzero(~same))
    return lost
