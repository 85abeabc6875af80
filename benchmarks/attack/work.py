"""Attacks by small requests that cause much work: A1, A4, A13, A14, A15."""

import gzip
import json
import time
from collections.abc import Sequence
from typing import Any

import msgpack  # type: ignore[import-untyped]
import numpy as np
import zstandard
from placecell_client import encode

from benchmarks.attack.stage import (
    AttackCase,
    Stage,
    clouds,
    delta_of,
    describe_body,
    described,
    template_of,
    with_columns,
)
from benchmarks.attack.target import OWNER, READER, ROBOT, Target
from benchmarks.attack.wire import DELTA, JSON, MAP, MSGPACK, AttackRequest, abandon, edit_request
from benchmarks.synthetic_maps.random_maps import EPOCH, MapTemplate
from placecell.core.types import UInt32

Cloud = np.ndarray[Any, np.dtype[np.float32]]

DEDUPLICATION_SECONDS = 10.0
DEDUPLICATION_MB = 200.0

VOXEL = 0.6
CELLS = 1 << 13
"""Number of cells of the voxel table that the crafted points fill."""


def coincident(stage: Stage) -> None:
    """A1: edits of many coincident segments with `deduplicate=true`."""
    count = stage.size(100_000, 8_000)
    with stage.service(own=False) as target:
        template = template_of(target)
        bodies = {
            "same place": _parked(stage, template, 1, count, noise=0.0),
            "parked robot": _parked(stage, template, 40, stage.size(40_000, 4_000), noise=0.05),
        }
        for name, body in bodies.items():
            repeated = edit_request(
                name.replace(" ", "-"), body, ROBOT, "create=true&deduplicate=true"
            )
            before = _begin(target)
            with stage.victim(target):
                for _ in range(2):  # a client repeats the call
                    answer = stage.ask(target, repeated)
                    stage.note(f"{name}, seconds", round(answer.seconds, 2))
                    stage.expect(
                        answer.status in {200, 201, 413}
                        and answer.seconds <= DEDUPLICATION_SECONDS,
                        f"{name}: an edit of {count} segments took {answer.seconds:.1f} s and was "
                        f"answered {answer.status}; {DEDUPLICATION_SECONDS:g} s are allowed.",
                    )
                for _ in range(3):
                    abandon(target, repeated)
                time.sleep(stage.size(3, 0))
            _expect_growth(stage, target, before, DEDUPLICATION_MB, name)


def crafted_points(stage: Stage) -> None:
    """A4: points that collide in one hash slot, and segments that are all within reach."""
    points = stage.size(50_000, 20_000)
    segment = _one_slot(points)
    crafted = describe_body([segment] * stage.size(10, 5))
    spread = clouds(stage.size(1_000, 500), stage.size(500, 300), stage.random, 30.0)
    spread = [
        each + stage.random.uniform(-20, 20, each.shape).astype(np.float32) for each in spread
    ]
    packed = {"Content-Type": MSGPACK}
    requests = {
        "crafted": [AttackRequest("POST", "/describe", crafted, READER, packed)],
        "crafted, JSON": [
            AttackRequest(
                "POST", "/describe", _as_json([segment] * 2), READER, {"Content-Type": JSON}
            )
        ],
        "spread": [
            AttackRequest("POST", path, describe_body(spread), READER, packed)
            for path in ("/describe", "/localize", "/match", "/describe")
        ],
    }
    with stage.service(own=False) as target:
        for name, each in requests.items():
            before = _begin(target)
            with stage.victim(target):
                answers = stage.ask_all(target, each, len(each), 60)
                for request in each * stage.size(3, 1):
                    abandon(target, request)
                time.sleep(stage.size(3, 0))
            stage.expect_no_failure(answers, name)
            slowest = max(answer.seconds for answer in answers)
            stage.note(f"{name}, seconds", round(slowest, 2))
            stage.expect(
                slowest <= 12, f"{name}: a request took {slowest:.1f} s; its deadline is 10 s."
            )
            stage.note(f"{name}, growth MB", round(target.peak_mb() - before))


def long_line(stage: Stage) -> None:
    """A13: aligning and merging two maps whose sensor positions lie on a line along y."""
    count, limit = stage.size(160_000, 20_000), float(stage.size(5, 2))
    environment = {"PLACECELL_LIMITS__ALIGNMENT_SECONDS": str(limit)}
    with stage.service(environment) as target:
        template = template_of(target)
        for name in ("line-a", "line-b"):
            body = encode(_line(stage, template, count))
            stage.ask(
                target, AttackRequest("PUT", f"/maps/{name}", body, OWNER, {"Content-Type": MAP})
            )
        merge = json.dumps({"maps": ["line-a", "line-b"], "dry_run": True}).encode()
        calls = {
            "align": AttackRequest("POST", "/maps/line-a/align/line-b", key=ROBOT),
            "align with se3": AttackRequest(
                "POST", "/maps/line-a/align/line-b?motion=se3", key=ROBOT
            ),
            "merge": AttackRequest(
                "POST", "/maps/merged/merge", merge, OWNER, {"Content-Type": JSON}
            ),
        }
        with stage.victim(target):
            for name, request in calls.items():
                answer = stage.ask(target, request)
                stage.note(f"{name}, seconds", round(answer.seconds, 2))
                stage.expect_no_failure([answer], name)
                stage.expect(
                    answer.seconds <= limit + 2,
                    f"{name}: it took {answer.seconds:.1f} s where the limit is {limit:g} s.",
                )


def bombs(stage: Stage) -> None:
    """A14: bodies of empty gzip members and zstd frames, of many map names, and tiny ones."""
    megabytes = stage.size(16, 2)
    room = (megabytes << 20) - 1_000
    member, frame = gzip.compress(b"", mtime=0), zstandard.ZstdCompressor().compress(b"")
    names = ",".join(['"aa"'] * (room // 5))
    short = ",".join(f'"{number:x}"' for number in range(room // 9))
    codes = '"model_id": "m", "codes": [[1]]'
    packed_names = msgpack.packb(
        {"model_id": "m", "codes": b"\0" * 32, "maps": ["a"] * (room // 2)}
    )
    many: dict[str, tuple[bytes, dict[str, str]]] = {
        "gzip members": (
            member * (room // len(member)),
            {"Content-Type": JSON, "Content-Encoding": "gzip"},
        ),
        "zstd frames": (
            frame * (room // len(frame)),
            {"Content-Type": JSON, "Content-Encoding": "zstd"},
        ),
        "names of maps": (
            f'{{{codes}, "maps": [{names}]}}'.encode(),
            {"Content-Type": JSON},
        ),
        "other names of maps": (
            f'{{{codes}, "maps": [{short}]}}'.encode(),
            {"Content-Type": JSON},
        ),
        "packed names of maps": (packed_names, {"Content-Type": MSGPACK}),
        "nested lists": (b'{"segments": ' + b"[" * (room // 2), {"Content-Type": JSON}),
        "digits": (b'{"k": ' + b"9" * room + b"}", {"Content-Type": JSON}),
    }
    with stage.service(own=False) as target:
        for name, (body, headers) in many.items():
            paths = ("/match", "/localize", "/match", "/localize")
            requests = [AttackRequest("POST", path, body, READER, headers) for path in paths]
            if "Content-Encoding" in headers:
                as_edit = headers | {"Content-Type": DELTA}
                path = "/maps/bomb/segments?create=true"
                requests.append(AttackRequest("POST", path, body, ROBOT, as_edit))
            before = _begin(target)
            with stage.victim(target):
                answers = stage.ask_all(target, requests, len(requests), 60)
            stage.expect_no_failure(answers, name)
            slowest = max(answer.seconds for answer in answers)
            stage.note(f"{name}, seconds", round(slowest, 2))
            stage.expect(
                slowest <= 5, f"{name}: a body of {megabytes} MB took {slowest:.1f} s to refuse."
            )
            _expect_growth(stage, target, before, 400, name)


def far_origin(stage: Stage) -> None:
    """A15: an origin at the limit of coordinates, and points at that limit too."""
    far = 1e8
    cases: list[tuple[list[float], list[float], list[float]]] = [
        ([far, 0, 0], [far, 0, 0], [far, 0, 0]),
        ([-far, -far, -far], [-far, -far, -far], [-far, -far, -far]),
        ([0, 0, far], [0, 0, 0], [0, 0, 0.9 * far]),
        ([1e8, 0, 0], [0, 0, 0], [0, 0, 0]),
        ([1e308, 0, 0], [1e8, 0, 0], [0, 0, 0]),
    ]
    base = clouds(1, 200, stage.random, 1.0)[0].astype(np.float64)
    with stage.service(own=False) as target:
        for origin, shift, sensor in cases:
            points = base + np.array(shift)
            packed = {
                "segments": [
                    {"points": points.astype("<f4").tobytes(), "sensor": [*map(float, sensor)]}
                ],
                "origin": [*map(float, origin)],
            }
            plain = packed | {"segments": [{"points": points.tolist(), "sensor": sensor}]}
            for path in ("/describe", "/match", "/localize"):
                answers = [
                    stage.ask(
                        target,
                        AttackRequest("POST", path, body, READER, {"Content-Type": media_type}),
                    )
                    for media_type, body in (
                        (MSGPACK, msgpack.packb(packed)),
                        (JSON, json.dumps(plain).encode()),
                    )
                ]
                for answer in answers:
                    is_beyond = np.abs(points + np.array(origin)).max() > far * 1.001
                    stage.expect(
                        answer.status in ({422} if is_beyond else {200, 422}),
                        f"{path} with origin {origin} and points about {shift} was answered "
                        f"{answer.status}; 422 was expected.",
                    )


def _parked(stage: Stage, template: MapTemplate, objects: int, count: int, noise: float) -> bytes:
    """Return the edit of a standing robot that sees the same objects repeatedly."""
    made = template.random_map(ROBOT, np.arange(1, count + 1, dtype=np.uint32), stage.random)
    frames = count // objects
    owners = np.arange(count) % objects
    places = stage.random.uniform(-20, 20, (objects, 3))
    codes = stage.random.integers(-127, 128, (objects, template.code_bytes)).astype(np.int8)
    parked = with_columns(
        made,
        codes=codes[owners],
        centroids=places[owners] + noise * stage.random.normal(size=(count, 3)),
        frame_index=(np.arange(count) // objects).astype(np.uint32),
        frame_times=EPOCH + 0.1 * np.arange(frames),
        frame_positions=np.zeros((frames, 3)),
        frame_orientations=np.tile(np.array([0, 0, 0, 1], np.float32), (frames, 1)),
    )
    return delta_of(parked)


def _line(stage: Stage, template: MapTemplate, count: int) -> Any:
    """Return a map along y with one segment per frame."""
    positions = np.zeros((count, 3))
    positions[:, 1] = 0.02 * np.arange(count)
    ids: UInt32 = np.arange(1, count + 1, dtype=np.uint32)
    return with_columns(
        template.random_map("line", ids, stage.random),
        centroids=positions + stage.random.uniform(-20, 20, (count, 3)),
        frame_index=np.arange(count, dtype=np.uint32),
        frame_times=EPOCH + np.arange(count),
        frame_positions=positions,
        frame_orientations=np.tile(np.array([0, 0, 0, 1], np.float32), (count, 1)),
    )


def _one_slot(points: int) -> Cloud:
    """Return a segment whose voxels share one slot of a table with an unseeded hash."""
    slots = 1
    while slots < 2 * points:
        slots *= 2
    most = 1_900
    x, y = np.divmod(np.arange(1, most * most, dtype=np.int64), most)
    key = (x * CELLS + y) * CELLS
    mixed = key ^ (key >> 13) * 7 ^ (key >> 26) * 31
    z = mixed & (CELLS - 1)
    good = ((mixed ^ z) & (slots - 1) == 0) & (z < most)
    cells = np.stack([x[good], y[good], z[good]], axis=1)[: points - 1]
    corner = np.zeros((1, 3))
    found = np.concatenate([corner, (cells + 0.5) * VOXEL])
    # The segment is centered on the sensor, because no point may be too far from it.
    centered: Cloud = (found - found.max(axis=0) / 2).astype("<f4")
    return centered


def _as_json(segments: Sequence[Cloud]) -> bytes:
    body = described(segments)
    for each, cloud in zip(body["segments"], segments, strict=True):
        each["points"] = np.round(cloud.astype(np.float64), 2).tolist()
    return json.dumps(body, separators=(",", ":")).encode()


def _begin(target: Target) -> float:
    """Reset the peak memory count; return the memory in use now, MB."""
    target.forget_peak()
    return target.resident_mb()


def _expect_growth(stage: Stage, target: Target, before: float, most: float, what: str) -> None:
    growth = target.peak_mb() - before
    stage.note(f"{what}, growth MB", round(growth))
    stage.expect(
        growth <= most, f"{what}: the service took {growth:.0f} MB more; {most:.0f} are allowed."
    )


CASES = (
    AttackCase("A1", coincident, "Memory and time are linear in the segments of an edit."),
    AttackCase("A4", crafted_points, "No points let recognition delay another robot's request."),
    AttackCase("A13", long_line, "Alignment and merge end at their time limit."),
    AttackCase("A14", bombs, "A body without content is refused at once."),
    AttackCase("A15", far_origin, "Coordinates whose sum exceeds the limit get a 422."),
)
