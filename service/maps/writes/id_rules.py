"""Rules for ids: which ids a key may write, and which segments it may replace or remove."""

import numpy as np
from placecell_client import CompactMap, Delta

from placecell.core.types import UInt32
from service.core.auth import Principal
from service.core.problems import Problem
from service.maps.store import MapHead, MapStore

SLACK = 1 << 20
"""Number of ids above the highest one in use that a robot may choose without reservation."""


def check_new(store: MapStore, principal: Principal, head: MapHead | None, ids: UInt32) -> None:
    """Check that new ids are reserved by this key, or near those in use; 409 if not.

    Args:
        store: store of the map.
        principal: principal of the request; an administrator may write any id.
        head: head of the map; None if the map is new.
        ids: ids of segments that the map does not have, ascending.
    """
    first = head.next_id if head is not None else 0
    limit = first + len(ids) + SLACK
    far = ids[ids >= limit]
    if principal.key.admin or not len(far):
        return
    if head is not None:
        owners = store.owners(head.uid, far.tolist())
        known = [owner is not None and owner.author == principal.name for owner in owners]
        far = far[~np.array(known)]
    if len(far):
        raise Problem(
            409,
            "id-not-reserved",
            f"{len(far)} ids, such as {int(far[-1])}, are not reserved and far above those in use. "
            f"Reserve ids (POST /maps/MAP/ids), or use ids below {limit}.",
            ids=far.tolist(),
        )


def check_authors(
    store: MapStore, principal: Principal, head: MapHead, old: UInt32, new: UInt32
) -> None:
    """Check that no other key wrote or reserved these ids; 409 if one did.

    Two robots may have the same name; their keys distinguish them.

    Args:
        store: store of the map.
        principal: principal of the request.
        head: head of the map.
        old: ids of segments that are replaced or removed, ascending.
        new: ids of segments that are added, ascending.
    """
    ids = np.union1d(old, new)
    owners = store.owners(head.uid, ids.tolist())
    is_old = np.isin(ids, old).tolist()
    taken = [
        id_
        for id_, owner, is_there in zip(ids.tolist(), owners, is_old, strict=True)
        if owner is not None
        and owner.author not in {"", principal.name}
        and (is_there or owner.is_reserved)
    ]
    if taken:
        raise Problem(
            409,
            "id-taken",
            f"{len(taken)} ids were written or reserved by another key. Use other ids (POST "
            '/maps/MAP/ids), or send If-Match: "ETAG" (or *) to write these.',
            ids=taken,
        )


def check_own(before: CompactMap, delta: Delta, owners: set[str | None]) -> None:
    """Check that an edit takes over or removes no other robot's segment; 409 if it does.

    Args:
        before: the segments that the edit replaces or removes, as they are.
        delta: the edit.
        owners: robots whose segments the edit may remove.
    """
    after = dict(zip(delta.changed.ids.tolist(), _robot_names(delta.changed), strict=True))
    taken = {
        id_: robot
        for id_, robot in zip(before.ids.tolist(), _robot_names(before), strict=True)
        if (after[id_] != robot if id_ in after else robot not in owners)
    }
    if taken:
        robots = ", ".join(sorted(set(taken.values())))
        raise Problem(
            409,
            "id-taken",
            f"{len(taken)} ids belong to segments of other robots: {robots:.200}. Use other ids "
            '(POST /maps/MAP/ids), or send If-Match: "ETAG" (or *) to replace or remove these.',
            ids=list(taken),
        )


def check_only_new(replaced: UInt32) -> None:
    """Check that an edit with `only_new` replaces no segment; 409 if it does."""
    if len(replaced):
        raise Problem(
            409,
            "id-taken",
            f"The map already has segments with {len(replaced)} of the ids, and only_new is set. "
            "Use other ids (POST /maps/MAP/ids), or omit only_new to replace these segments.",
            ids=replaced.tolist(),
        )


def _robot_names(content: CompactMap) -> list[str]:
    """Return the robot of each segment."""
    return [content.robots[index] for index in content.robot.tolist()]
