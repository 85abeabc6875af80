"""Attacks that fill, move or alter stored data: A2, A8, A10, A16-A18, A22-A24, A28."""

import os
import shutil
import sqlite3
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path

import numpy as np
from placecell_client import Client, CompactMap, Delta, ServiceError, encode

from benchmarks.attack.stage import (
    NONE,
    VICTIM_MAP,
    AttackCase,
    Stage,
    delta_of,
    template_of,
    with_columns,
)
from benchmarks.attack.target import ONCE, OWNER, ROBOT, VICTIM, WRITER, Target
from benchmarks.attack.wire import MAP, AttackRequest, AttackResponse, edit_request
from benchmarks.synthetic_maps.random_maps import EPOCH, MapTemplate
from placecell.core.types import Float64, UInt32
from service.child_process import STOP_SECONDS

LAST_ID = (1 << 32) - 1
DATABASE = "maps.sqlite"

EMPTY_MAPS_MB = 200.0
"""Largest memory that 10,000 empty maps may take, MB."""

DISK_BYTES = 24 << 20
"""Size of the disk to fill, bytes."""

DAY = 86_400.0

REFUSALS = {400, 403, 409, 413, 422, 429, 507}


def empty_maps(stage: Stage) -> None:
    """A2: as many empty maps as one key may create, then as many over all keys."""
    count = stage.size(10_000, 200)
    with stage.service(own=not stage.short) as target:
        template = template_of(target)
        body = delta_of(template.empty_map())
        target.forget_peak()
        before, made = target.resident_mb(), 0
        with stage.victim(target):
            for key in (ROBOT, WRITER, OWNER):
                if made == count:
                    break
                requests = [
                    edit_request(f"{key}-{n}", body, key, "create=true")
                    for n in range(count - made)
                ]
                answers = stage.ask_all(target, requests, 4)
                made += sum(answer.status == 201 for answer in answers)
                stage.note(f"maps of {key}", sum(answer.status == 201 for answer in answers))
                stage.expect(
                    {answer.status for answer in answers} <= {201, *REFUSALS},
                    f"New maps were answered {sorted({answer.status for answer in answers})}.",
                )
        growth = target.peak_mb() - before
        stage.note("maps", made)
        stage.note("growth MB", round(growth))
        # A short run makes few maps; 15% of the allowed growth is for the service itself.
        most = EMPTY_MAPS_MB * max(made / 10_000, 0.15)
        stage.expect(
            growth <= most, f"{made} empty maps took {growth:.0f} MB; {most:.0f} are allowed."
        )
        if not stage.short:
            _expect_after_start(stage, target, made, before, most)
    _expect_limit_of_maps(stage)


def all_ids(stage: Stage) -> None:
    """A8: the highest id and endless id reservations, also in shared maps."""
    with stage.service(own=not stage.short) as target:
        template = template_of(target)
        file = {"Content-Type": MAP}
        for name in ("by-edit", "by-put", "by-reserve", "by-deduplication"):
            if name != "by-put":
                target.client(VICTIM).edit_map(name, Delta(template.empty_map(), NONE), create=True)
        last = _with_ids(stage, template, ROBOT, [LAST_ID])
        near = _with_ids(stage, template, ROBOT, [1, LAST_ID - 10])
        attacks = {
            "by-edit": [edit_request("by-edit", delta_of(each), ROBOT) for each in (last, near)],
            "by-deduplication": [
                edit_request("by-deduplication", delta_of(last), ROBOT, "deduplicate=true")
            ],
            "by-put": [
                AttackRequest("PUT", "/maps/by-put", encode(near), ROBOT, file),
                AttackRequest("PUT", "/maps/by-put", encode(last), ROBOT, file | {"If-Match": "*"}),
            ],
            "by-reserve": [AttackRequest("POST", "/maps/by-reserve/ids?count=1000000", key=ROBOT)]
            * stage.size(4_400, 300),
        }
        for name, requests in attacks.items():
            statuses = set[int]()
            for request in requests:
                statuses.add(stage.ask(target, request).status)
                if name == "by-reserve" and statuses != {200}:
                    break
            stage.expect(500 not in statuses and 0 not in statuses, f"{name}: {statuses}.")
            if name == "by-reserve":
                stage.expect(
                    statuses != {200}, f"One key reserved {len(requests):,} million ids of a map."
                )
            if target.client(OWNER).maps() and name not in {
                each.name for each in target.client(OWNER).maps()
            }:
                continue  # the service refused the write, so there is no map
            answer = stage.ask(
                target, AttackRequest("POST", f"/maps/{name}/ids?count=1000", key=VICTIM)
            )
            stage.expect(
                answer.status == 200,
                f"{name}: after it another key's reservation was answered {answer.status}.",
            )
        if stage.short:
            return
        target.stop()
        target.start()
        answer = stage.ask(
            target, AttackRequest("POST", "/maps/by-edit/ids?count=1000", key=VICTIM)
        )
        stage.expect(answer.status == 200, f"After a start ids were answered {answer.status}.")


def moved_database(stage: Stage) -> None:
    """A10: the database is moved away from a running service, read from, and put back."""
    with stage.service() as target:
        template = template_of(target)
        with stage.victim(target):
            time.sleep(stage.size(3, 1.5))
        acknowledged = target.client(OWNER).get_map(VICTIM_MAP).ids.tolist()
        database = target.data / DATABASE
        moved = target.folder / "moved.sqlite"
        database.rename(moved)
        delta = delta_of(_with_ids(stage, template, VICTIM, [5]))
        requests = [
            AttackRequest("GET", f"/maps/{VICTIM_MAP}/versions", key=VICTIM),
            AttackRequest("GET", f"/maps/{VICTIM_MAP}?version=1", key=VICTIM),
            AttackRequest("GET", f"/maps/{VICTIM_MAP}/changes?since=0", key=VICTIM),
            AttackRequest("GET", f"/maps/{VICTIM_MAP}/changes?since=1", key=VICTIM),
            AttackRequest("POST", f"/maps/{VICTIM_MAP}/ids?count=1", key=VICTIM),
            AttackRequest("POST", f"/maps/{VICTIM_MAP}/versions/1/restore", key=VICTIM),
            edit_request(VICTIM_MAP, delta, VICTIM),
            AttackRequest("POST", f"/maps/{VICTIM_MAP}/compact", key=OWNER),
        ]
        for request in requests:
            answer = stage.ask(target, request)
            # Maps in memory may still be read.
            good = {503} if request.method == "POST" else {200, 503}
            stage.expect(
                answer.status in good,
                f"Without its database {request.method} {request.path} was answered "
                f"{answer.status}.",
            )
            stage.expect(
                not database.exists(), f"{request.method} {request.path} made an empty database."
            )
        ready = stage.ask(target, AttackRequest("GET", "/readyz"))
        stage.expect(ready.status == 503, f"Without its database /readyz is {ready.status}.")
        database.unlink(missing_ok=True)
        moved.rename(database)
        target.kill()
        target.start()
        stage.expect_there(target, VICTIM_MAP, acknowledged, "after the database was moved")


def seen_in_the_future(stage: Stage) -> None:
    """A16: a robot claims that it saw another robot's segment in the year 2106."""
    late = (1 << 32) - 1
    with stage.service(own=False) as target:
        template = template_of(target)
        for name, column, moment in (
            ("by-seen", late, EPOCH + 100),
            ("by-time", None, 8e9),
            ("both", late, 8e9),
        ):
            victims = _with_ids(stage, template, VICTIM, [1])
            target.client(VICTIM).edit_map(name, Delta(victims, NONE), create=True)
            again = with_columns(
                victims,
                ids=np.array([2], np.uint32),
                robots=(ROBOT,),
                frame_times=np.array([moment]),
                **({} if column is None else {"seen": np.array([column], np.uint32)}),
            )
            stage.ask(target, edit_request(name, delta_of(again), ROBOT, "deduplicate=true"))
            ids, seen = last_seen(target.client(OWNER).get_map(name))
            latest = float(seen[ids == 1].max(initial=0.0))
            stage.expect(
                latest <= time.time() + DAY,
                f"{name}: another robot's segment was last seen {latest - time.time():.0f} s from "
                "now, so it is never pruned.",
            )


def last_seen(content: CompactMap) -> tuple[UInt32, Float64]:
    """Id of each segment and the time when it was last seen, seconds."""
    times = content.frame_times[content.frame_index]
    return content.ids, times if content.seen is None else content.seen.astype(np.float64)


def long_history(stage: Stage) -> None:
    """A17: edits that replace the same segments again and again."""
    with stage.service(own=False) as target:
        limits = target.client(OWNER).info().limits
    names = [name for name in limits if "byte" in name and name not in {"body_bytes", "map_bytes"}]
    names = [name for name in names if any(word in name for word in ("robot", "key", "map", "all",
             "stored", "history", "total"))]  # fmt: skip
    stage.note("limits of bytes", names)
    if not stage.expect(bool(names), "/info names no limit of the bytes that a key may store."):
        return
    bytes_ = 2 << 20
    environment = {f"PLACECELL_LIMITS__{name.upper()}": str(bytes_) for name in names}
    count = 2_000
    with stage.service(environment) as target:
        template = template_of(target)
        ids = np.arange(1, count + 1, dtype=np.uint32)
        target.client(ROBOT).edit_map("long", Delta(template.empty_map(), NONE), create=True)
        statuses = []
        for _ in range(200):
            request = edit_request(
                "long", delta_of(template.random_map(ROBOT, ids, stage.random)), ROBOT
            )
            statuses.append(stage.ask(target, request).status)
            if statuses[-1] != 200:
                break
        stored = (target.data / DATABASE).stat().st_size
        stage.note("edits", len(statuses))
        stage.note("database bytes", stored)
        # Compaction may drop old versions meanwhile.
        stage.expect(
            statuses[-1] in REFUSALS or stored < 8 * bytes_,
            f"{len(statuses)} edits of {count} segments store {stored} bytes, where {bytes_} are "
            "the limit.",
        )
        victims = target.client(VICTIM).edit_map(
            "victims", Delta(_with_ids(stage, template, VICTIM, [1]), NONE), create=True
        )
        stage.expect(victims.changed == 1, "Another key could not write.")
        if statuses[-1] in REFUSALS:
            freed = stage.ask(target, AttackRequest("DELETE", "/maps/long", key=ROBOT))
            stage.expect(freed.status == 204, f"At the limit DELETE was answered {freed.status}.")
            delta = delta_of(template.random_map(ROBOT, ids, stage.random))
            again = stage.ask(target, edit_request("long", delta, ROBOT, "create=true"))
            stage.expect(again.status == 201, f"After DELETE a write was answered {again.status}.")


def full_disk(stage: Stage) -> None:
    """A18: a robot and other programs fill a disk; then maps are deleted to free it."""
    freeing = {
        "DELETE": AttackRequest("DELETE", "/maps/hoard", key=OWNER),
        "age": AttackRequest("POST", "/maps/hoard/age?unseen_since=4000000000", key=OWNER),
        "compact": AttackRequest("POST", "/maps/hoard/compact?keep=1", key=OWNER),
    }
    for name, request in freeing.items():
        if stage.short and name != "DELETE":
            continue
        with _small_disk(stage) as is_small:
            if not is_small:
                stage.note("skipped", "no small disk can be mounted here")
                return
            _fill_and_free(stage, name, request)


def removed_lock(stage: Stage) -> None:
    """A22: the lock file is removed and a second service starts on the directory."""
    with stage.service() as target:
        template = template_of(target)
        target.client(VICTIM).edit_map(VICTIM_MAP, Delta(template.empty_map(), NONE), create=True)
        (target.data / "lock").unlink()
        acknowledged = set[int]()
        with _second(target) as address:
            stage.note("second service started", address is not None)
            for number in range(40):
                delta = Delta(_with_ids(stage, template, VICTIM, [number + 1]), NONE)
                uses_second = address is not None and number % 2
                where = address if uses_second and address is not None else target.address
                with Client(where, 20, key=target.keys[VICTIM], retries=ONCE) as client:
                    try:
                        client.edit_map(VICTIM_MAP, delta)
                        acknowledged.add(number + 1)
                        stage.found.statuses["200"] += 1
                    except ServiceError as error:
                        stage.found.statuses[str(error.status)] += 1
                        stage.expect(
                            error.status in {409, 412, 503},
                            f"A write beside the second service was answered {error.status}; "
                            "503 was expected.",
                        )
        ready = stage.ask(target, AttackRequest("GET", "/readyz"))
        stage.note("readyz", ready.status)
        target.kill()
        target.start()
        stage.expect_there(target, VICTIM_MAP, acknowledged, "after the lock was removed")


def restored_backup(stage: Stage) -> None:
    """A23: ids are reserved, an earlier backup is restored, and ids are reserved again."""
    with stage.service() as target:
        template = template_of(target)
        first = _with_ids(stage, template, VICTIM, [1, 2, 3])
        target.client(VICTIM).edit_map(VICTIM_MAP, Delta(first, NONE), create=True)
        backup = target.folder / "backup.sqlite"
        with (
            closing(sqlite3.connect(target.data / DATABASE)) as source,
            closing(sqlite3.connect(backup)) as copy,
        ):
            source.backup(copy)
        given = {*target.client(VICTIM).reserve_ids(VICTIM_MAP, 5_000).tolist()}
        for name in ("while it runs down", "after a kill"):
            if name == "after a kill":
                target.kill()
            else:
                target.stop()
            for tail in ("", "-wal", "-shm"):
                (target.data / (DATABASE + tail)).unlink(missing_ok=True)
            shutil.copyfile(backup, target.data / DATABASE)
            target.start()
            answer = stage.ask(
                target, AttackRequest("POST", f"/maps/{VICTIM_MAP}/ids?count=100", key=VICTIM)
            )
            if not stage.expect(answer.status == 200, f"Ids were answered {answer.status}."):
                continue
            begin = answer.json()["first"]
            again = {*range(begin, begin + 100)} & given
            stage.expect(not again, f"{name}: {len(again)} ids were given out twice.")
            given |= {*range(begin, begin + 100)}


def delete_of_shared_map(stage: Stage) -> None:
    """A24: a robot's key deletes a map that holds other robots' history."""
    with stage.service(own=False) as target:
        template = template_of(target)
        victims = _with_ids(stage, template, VICTIM, [1, 2])
        target.client(VICTIM).edit_map("shared", Delta(victims, NONE), create=True)
        target.client(ROBOT).edit_map("shared", Delta(_with_ids(stage, template, ROBOT, [7]), NONE))
        gone = np.array([1, 2], np.uint32)
        target.client(VICTIM).edit_map("shared", Delta(template.empty_map(), gone), robot=VICTIM)
        for name, request in {
            "DELETE": AttackRequest("DELETE", "/maps/shared", key=ROBOT),
            "compact": AttackRequest("POST", "/maps/shared/compact", key=ROBOT),
        }.items():
            answer = stage.ask(target, request)
            stage.expect(
                answer.status == 403, f"{name} of others' history was answered {answer.status}."
            )
        answer = stage.ask(target, AttackRequest("GET", "/maps/shared?version=1", key=VICTIM))
        stage.found.lost += answer.status != 200
        stage.expect(answer.status == 200, "The victim's version is lost.")
        target.client(ROBOT).edit_map(
            "own", Delta(_with_ids(stage, template, ROBOT, [1]), NONE), create=True
        )
        own = stage.ask(target, AttackRequest("DELETE", "/maps/own", key=ROBOT))
        stage.expect(own.status == 204, f"A robot's own map: DELETE was answered {own.status}.")


def flipped_bits(stage: Stage) -> None:
    """A28: bits of commit notes flip on the disk."""
    changes = {
        "author": "UPDATE commits SET author = 'mallory' WHERE sequence = 2",
        "time": "UPDATE commits SET time = time + 1e6 WHERE sequence = 2",
        "operation": "UPDATE commits SET operation = 'put' WHERE sequence = 2",
        "changed": "UPDATE commits SET changed = changed + 1 WHERE sequence = 2",
        "first author": "UPDATE commits SET author = 'mallory' WHERE sequence = 1",
    }
    with stage.service() as target:
        template = template_of(target)
        for number in range(3):
            made = _with_ids(stage, template, VICTIM, [number + 1])
            target.client(VICTIM).edit_map(VICTIM_MAP, Delta(made, NONE), create=True)
        target.stop()
        database = target.data / DATABASE
        whole = database.read_bytes()
        for name, change in changes.items():
            for tail in ("-wal", "-shm"):
                (target.data / (DATABASE + tail)).unlink(missing_ok=True)
            database.write_bytes(whole)
            with closing(sqlite3.connect(database)) as connection:
                connection.execute(change)
                connection.commit()
            shutil.rmtree(target.data / "cache", ignore_errors=True)
            try:
                target.start()
            except (RuntimeError, ServiceError) as error:
                stage.note(name, f"refused at the start: {error!s:.80}")
                target.kill()
                target.died = ""
                continue
            listed = stage.ask(target, AttackRequest("GET", "/maps", key=OWNER))
            versions = stage.ask(
                target, AttackRequest("GET", f"/maps/{VICTIM_MAP}/versions", key=OWNER)
            )
            is_reported = (
                versions.status != 200
                or VICTIM_MAP in listed.json().get("damaged", [])
                or any(each.get("damaged") for each in versions.json()["versions"])
            )
            stage.expect(is_reported, f"A changed {name} of a commit is not reported.")
            target.stop()
        for tail in ("-wal", "-shm"):
            (target.data / (DATABASE + tail)).unlink(missing_ok=True)
        database.write_bytes(whole)
        target.start()
        versions = stage.ask(
            target, AttackRequest("GET", f"/maps/{VICTIM_MAP}/versions", key=OWNER)
        )
        stage.expect(versions.status == 200, "The unchanged database is refused.")


def _expect_after_start(
    stage: Stage, target: Target, made: int, before: float, most: float
) -> None:
    """Expect that all maps survive a kill and take no more memory than before."""
    target.kill()
    target.start()
    again = target.peak_mb() - before
    stage.note("growth MB after a start", round(again))
    stage.expect(again <= most + 60, f"After a start {made} empty maps took {again:.0f} MB.")
    names = {each.name for each in target.client(OWNER, 300).maps()}
    gone = made - len(names - {VICTIM_MAP})
    stage.found.lost += max(0, gone)
    stage.expect(gone <= 0, f"{gone} maps are lost after a kill.")


def _expect_limit_of_maps(stage: Stage) -> None:
    """Expect that /info states a limit on maps and that the service enforces it."""
    with stage.service(own=False) as target:
        limits = target.client(OWNER).info().limits
    names = [name for name in limits if name in {"maps", "key_maps"}]
    stage.note("limits of maps", names)
    names = names[:1] if stage.short else names
    if not stage.expect(bool(names), "/info names no limit of the maps that a key may make."):
        return
    for name in names:
        with stage.service({f"PLACECELL_LIMITS__{name.upper()}": "5"}) as target:
            body = delta_of(template_of(target).empty_map())
            statuses = [
                stage.ask(
                    target,
                    edit_request(f"m-{number}", body, ROBOT, "create=true"),
                ).status
                for number in range(7)
            ]
            stage.expect(
                statuses[:5] == [201] * 5 and {*statuses[5:]} <= REFUSALS,
                f"{name} of 5: seven new maps were answered {statuses}.",
            )
            gone = stage.ask(target, AttackRequest("DELETE", "/maps/m-0", key=ROBOT))
            stage.expect(gone.status == 204, f"At the limit DELETE was answered {gone.status}.")


def _fill_and_free(stage: Stage, name: str, request: AttackRequest) -> None:
    with stage.service() as target:
        template = template_of(target)
        stage.ask(target, AttackRequest("GET", "/readyz"))
        first = _with_ids(stage, template, VICTIM, [1])
        target.client(VICTIM).edit_map(VICTIM_MAP, Delta(first, NONE), create=True)
        target.client(ROBOT).edit_map("hoard", Delta(template.empty_map(), NONE), create=True)
        acknowledged, number = {1}, 0
        statuses = list[int]()
        while number < 400 and statuses[-1:] != [507]:
            number += 1
            ids = np.arange(1, 8_001, dtype=np.uint32)
            body = delta_of(template.random_map(ROBOT, ids, stage.random))
            statuses.append(stage.ask(target, edit_request("hoard", body, ROBOT)).status)
        stage.expect(
            statuses[-1] == 507, f"On a full disk an edit was answered {statuses[-1]}; not 507."
        )
        # Another program fills the rest of the disk: the reserve must be the service's own file.
        ballast = _fill(target.data)
        for id_ in range(2, 40):
            delta = delta_of(_with_ids(stage, template, VICTIM, [id_]))
            answer = stage.ask(target, edit_request(VICTIM_MAP, delta, VICTIM))
            if answer.status != 200:
                break
            acknowledged.add(id_)
        stage.expect(
            answer.status == 507, f"On a full disk an edit was answered {answer.status}; not 507."
        )
        ready = stage.ask(target, AttackRequest("GET", "/readyz"))
        stage.expect(ready.status == 503, f"On a full disk /readyz is {ready.status}.")
        target.kill()
        target.start()
        stage.expect_there(target, VICTIM_MAP, acknowledged, "after a start on a full disk")
        freed = stage.ask(target, request)
        stage.expect(
            freed.status in {200, 204}, f"On a full disk {name} was answered {freed.status}."
        )
        if ballast.exists():
            ballast.unlink()
        body = delta_of(_with_ids(stage, template, VICTIM, [100]))
        answer = _soon(stage, target, edit_request(VICTIM_MAP, body, VICTIM))
        stage.expect(
            answer.status == 200, f"After {name} freed the disk a write was {answer.status}."
        )
        ready = _soon(stage, target, AttackRequest("GET", "/readyz"))
        stage.expect(ready.status == 200, f"After {name} /readyz is {ready.status}.")


def _soon(stage: Stage, target: Target, request: AttackRequest) -> AttackResponse:
    """Repeat a request until it succeeds, for 5 seconds at most."""
    for _ in range(20):
        answer = stage.ask(target, request)
        if answer.status < 300:
            break
        time.sleep(0.25)
    return answer


def _fill(folder: Path) -> Path:
    """Fill the disk of a folder with a file, as another program might."""
    file = folder / "ballast"
    with file.open("wb", buffering=0) as written:
        for size in (1 << 20, 1 << 12, 1):
            try:
                while True:
                    if not written.write(b"\1" * size):
                        break
            except OSError:
                continue
    return file


@contextmanager
def _small_disk(stage: Stage) -> Iterator[bool]:
    """Mount a small disk for the next service's data directory; yield whether it is mounted."""
    folder = stage.next_data()
    folder.mkdir(parents=True)
    options = ["-t", "tmpfs", "-o", f"size={DISK_BYTES}", "tmpfs", str(folder)]
    if os.geteuid() != 0 or subprocess.run(["mount", *options], check=False).returncode:
        yield False
        return
    try:
        yield True
    finally:
        subprocess.run(["umount", "--lazy", str(folder)], check=False)


@contextmanager
def _second(target: Target) -> Iterator[str | None]:
    """Start a second service on the same data; yield its address, None if it refuses to start."""
    command = [sys.executable, "-m", "cli", "serve", "--port", "0", "--data-dir", str(target.data)]
    command += ["--keys-file", str(target.keys_file)]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    ) as process:
        assert process.stdout is not None
        line = process.stdout.readline()
        try:
            yield line.split("listens on ")[1].split()[0] if "listens on" in line else None
        finally:
            process.terminate()
            try:
                process.wait(STOP_SECONDS)
            except subprocess.TimeoutExpired:
                process.kill()


def _with_ids(stage: Stage, template: MapTemplate, robot: str, ids: list[int]) -> CompactMap:
    chosen: UInt32 = np.array(ids, np.uint32)
    return template.random_map(robot, chosen, stage.random)


CASES = (
    AttackCase(
        "A2", empty_maps, "The number of maps is limited, and empty maps take little memory."
    ),
    AttackCase("A8", all_ids, "No key can take all ids of a map."),
    AttackCase(
        "A10",
        moved_database,
        "With its database moved away, the service answers 503 and loses nothing.",
    ),
    AttackCase("A16", seen_in_the_future, "No segment is last seen in the future."),
    AttackCase("A17", long_history, "The bytes that a key stores are limited, history included."),
    AttackCase(
        "A18", full_disk, "Deletions free a full disk, and /readyz reports that it is full."
    ),
    AttackCase(
        "A22", removed_lock, "A service whose lock was removed refuses writes.", in_short=False
    ),
    AttackCase(
        "A23",
        restored_backup,
        "Ids are given out once, also after a backup is restored.",
        in_short=False,
    ),
    AttackCase("A24", delete_of_shared_map, "A robot's key cannot delete others' history."),
    AttackCase("A28", flipped_bits, "The service reports changed commit notes.", in_short=False),
)
