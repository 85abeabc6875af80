"""Agents that write maps: no segment takes the id of another, and each robot removes its own."""

from concurrent.futures import ThreadPoolExecutor
from threading import Barrier
from typing import Any

import numpy as np
from placecell_client import Client, Delta, decode, encode_delta
from placecell_client.http.retry import Retries

from placecell.core.types import Int8
from placecell.descriptors.manifest import Manifest
from robot.core.settings import AgentSettings
from robot.mapping.map_out import Capture, EditMaker, SeenSegments
from robot.mapping.spool import SpoolEntry
from robot.mapping.upload import send
from robot.service_link import ServiceLink
from tests.service.service_builders import map_of, random_codes

EDITS, ROWS = 12, 3


class MeetingLink(ServiceLink):
    """Link whose first upload waits for that of the other agent."""

    def __init__(self, client: Client, barrier: Barrier) -> None:
        super().__init__(client)
        self._barrier: Barrier | None = barrier

    def upload(self, name: str, delta: bytes, robot: str, create: bool) -> None:
        barrier, self._barrier = self._barrier, None
        if barrier is not None:
            barrier.wait(30.0)
        super().upload(name, delta, robot, create)


def codes_of(robot: str) -> Int8:
    return random_codes(EDITS * ROWS, seed=len(robot))


def upload(link: ServiceLink, settings: AgentSettings, model_id: str) -> set[str]:
    """Send the edits of an agent, whose ids begin with 0; return the maps that it wrote."""
    entries = []
    for number in range(EDITS):
        rows = slice(number * ROWS, (number + 1) * ROWS)
        changed = map_of(
            codes_of(settings.robot)[rows],
            model_id,
            first_id=number * ROWS,
            robot=settings.robot,
            frame=f"{settings.robot}/{settings.session}/0",
        )
        content = encode_delta(Delta(changed, np.zeros(0, np.uint32)))
        entries.append(SpoolEntry(number, settings.session, 0, content))
    result = send(link, entries, {}, settings.map, settings.robot)
    assert result.refused is None
    assert result.error is None
    return {name for _, name in result.sent}


def test_agents_that_begin_one_map_at_once_write_two_maps(service: Any, manifest: Manifest) -> None:
    client = Client("http://testserver", transport=service._transport, retries=Retries(attempts=1))
    barrier = Barrier(2)
    agents = [AgentSettings(map="yard", robot=robot) for robot in ("a", "bob")]

    def run(settings: AgentSettings) -> set[str]:
        return upload(MeetingLink(client, barrier), settings, manifest.model_id)

    with ThreadPoolExecutor(2) as pool:
        written = list(pool.map(run, agents))
    assert [len(each) for each in written] == [1, 1]
    assert len(set.union(*written)) == 2
    assert "yard" in set.union(*written)
    for settings, (name,) in zip(agents, written, strict=True):
        stored = decode(service.get(f"/maps/{name}").content)
        assert stored.ids.tolist() == list(range(EDITS * ROWS))
        assert set(stored.robots) == {settings.robot}
        np.testing.assert_array_equal(stored.codes, codes_of(settings.robot))


def test_agents_of_one_name_have_their_own_sessions_and_maps(
    service: Any, manifest: Manifest
) -> None:
    """Two robots without a name, or one that starts again, do not replace the first one's ids."""
    client = Client("http://testserver", transport=service._transport, retries=Retries(attempts=1))
    link = ServiceLink(client)
    first = upload(link, AgentSettings(map="yard"), manifest.model_id)
    before = service.get("/maps/yard").content
    second = upload(link, AgentSettings(map="yard"), manifest.model_id)
    assert (first, second) == ({"yard"}, {"yard-robot"})
    assert service.get("/maps/yard").content == before


def test_robot_removes_its_own_segments_with_an_edit_that_adds_none(
    service: Any, manifest: Manifest
) -> None:
    """A segment is seen to move at a keyframe that shows nothing new."""
    client = Client("http://testserver", transport=service._transport, retries=Retries(attempts=1))
    edits = EditMaker("ann", "s")
    entries: list[SpoolEntry] = []
    for meters, ids, moved in ((0.0, [1, 2], []), (2.0, [1], [2]), (4.0, [1, 3], [])):
        codes = random_codes(len(ids), seed=len(entries))
        centroids = 5.0 * np.array(ids)[:, None] * np.ones(3)
        seen = SeenSegments(np.array(ids), codes, centroids, manifest.model_id, "1")
        capture = Capture(meters, np.eye(4))
        edit = edits.add(seen, capture, meters, np.array(moved, np.int64))
        assert edit is not None
        entries.append(SpoolEntry(edit.sequence, "s", edit.part, edit.content))
    result = send(ServiceLink(client), entries, {}, "yard", "ann")
    assert [name for _, name in result.sent] == ["yard"] * 3, result
    assert decode(service.get("/maps/yard").content).ids.tolist() == [0, 2]
