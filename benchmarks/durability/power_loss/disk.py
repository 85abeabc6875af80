"""Simulated disk that may lose everything that was not synced.

After a power cut a file holds its content of the last sync, and any part of the later writes: a
later write without an earlier one, or some sectors of a write without the others. A new, changed or
removed file name is certain only after a sync of its folder.
"""

import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from typing import Literal

from benchmarks.durability.power_loss.disk_log import Step

SECTOR = 512
"""Number of bytes that a disk writes completely or not at all."""

Keep = Literal["nothing", "everything", "names", "data", "some"]
"""Unsynced changes that the disk keeps: none, all, those of names, those of data, or some."""

KEEPS: tuple[Keep, ...] = ("nothing", "everything", "names", "data", "some")


@dataclass(slots=True, eq=False)
class _File:
    """Synced content of a file, and the later writes and truncations."""

    synced: bytearray = field(default_factory=bytearray)
    pending: list[Step] = field(default_factory=list)


@dataclass(slots=True, eq=False)
class _Change:
    """Change of names at one moment: the file of each name; None: the name is removed."""

    names: dict[str, _File | None]
    ended: int


@dataclass(slots=True, eq=False)
class Disk:
    """Files of a folder and its subfolders, built by the steps of a log.

    Attributes:
        lost: endings of the names of files that do not outlive their process.
    """

    lost: tuple[str, ...] = ()
    _names: dict[str, _File] = field(default_factory=dict)
    _synced: dict[str, _File] = field(default_factory=dict)
    _pending: list[_Change] = field(default_factory=list)
    _folders: set[str] = field(default_factory=set)

    def apply(self, step: Step) -> bool:
        """Apply a step; return whether it changes the files that a power cut may leave."""
        if step.kind == "said" or step.path.endswith(self.lost):
            return False
        if step.kind in {"open", "folder"}:
            if step.path in self._names:
                return False
            self._change({step.path: _File()}, step)
            if step.kind == "folder":
                self._folders.add(step.path)
        elif step.kind == "rename":
            self._change({step.path: None, step.to: self._names[step.path]}, step)
        elif step.kind == "remove":
            self._change({step.path: None}, step)
        elif step.kind == "sync":
            self._sync(step)
        else:
            self._names[step.path].pending.append(step)
        return True

    def left(self, keep: Keep, draw: random.Random) -> dict[str, bytes]:
        """Return the files that a power cut now may leave, by path."""
        names = dict(self._synced)
        for change in self._kept_names(keep, draw):
            _apply(change, names)
        return {
            path: _content(file, keep, draw)
            for path, file in names.items()
            if path not in self._folders and self._is_reached(path, names)
        }

    def _change(self, names: dict[str, _File | None], step: Step) -> None:
        change = _Change(names, step.ended)
        self._pending.append(change)
        _apply(change, self._names)

    def _sync(self, step: Step) -> None:
        file = self._names.get(step.path)
        if file is not None:
            # A write that had not ended when the sync began may not be synced.
            done = [write for write in file.pending if write.ended < step.begun]
            file.synced = bytearray(_written(file.synced, done))
            file.pending = [write for write in file.pending if write.ended >= step.begun]
        mine = [
            change
            for change in self._pending
            if change.ended < step.begun and _folder_of(change) == step.path
        ]
        for change in mine:
            _apply(change, self._synced)
            self._pending.remove(change)

    def _kept_names(self, keep: Keep, draw: random.Random) -> Sequence[_Change]:
        if keep in {"nothing", "data"}:
            return []
        if keep in {"everything", "names"}:
            return self._pending
        if draw.random() < 0.5:  # like a journaling file system: a change needs all earlier ones
            return self._pending[: draw.randint(0, len(self._pending))]
        return [change for change in self._pending if draw.random() < 0.5]

    def _is_reached(self, path: str, names: Mapping[str, _File]) -> bool:
        """Return whether the folder of a file exists, if the log made the folder."""
        folder = str(PurePosixPath(path).parent)
        return folder in names or folder not in self._folders


def write_files(files: Mapping[str, bytes], root: Path, folder: Path) -> None:
    """Write files into an empty folder.

    Args:
        files: content by path.
        root: folder of these paths.
        folder: an empty folder.
    """
    for path, content in files.items():
        copy = folder / Path(path).relative_to(root)
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_bytes(content)


def _apply(change: _Change, names: dict[str, _File]) -> None:
    for name, file in change.names.items():
        if file is None:
            names.pop(name, None)
        else:
            names[name] = file


def _folder_of(change: _Change) -> str:
    return str(PurePosixPath(next(iter(change.names))).parent)


def _content(file: _File, keep: Keep, draw: random.Random) -> bytes:
    if keep in {"nothing", "names"}:
        return bytes(file.synced)
    if keep == "some":
        return _written(file.synced, _some(file.pending, draw))
    return _written(file.synced, file.pending)


def _some(pending: Sequence[Step], draw: random.Random) -> list[Step]:
    """Return the writes that reached the disk: the first ones, any ones, or any sectors of them."""
    chance = draw.random()
    if chance < 0.3:
        return list(pending[: draw.randint(0, len(pending))])
    share = draw.random()
    some = pending if chance > 0.6 else [step for step in pending if draw.random() < share]
    if chance < 0.45:
        return list(some)
    return [part for step in some for part in _sectors(step) if draw.random() < share]


def _sectors(step: Step) -> list[Step]:
    if step.kind != "write":
        return [step]
    end = step.offset + len(step.data)
    starts = [step.offset, *range((step.offset // SECTOR + 1) * SECTOR, end, SECTOR)]
    return [
        Step(
            kind="write",
            begun=step.begun,
            ended=step.ended,
            path=step.path,
            offset=start,
            data=step.data[start - step.offset : stop - step.offset],
        )
        for start, stop in zip(starts, [*starts[1:], end], strict=True)
    ]


def _written(before: bytes | bytearray, steps: Sequence[Step]) -> bytes:
    content = bytearray(before)
    for step in steps:
        end = step.offset + len(step.data)
        if len(content) < end or step.kind == "cut":
            # Unwritten bytes read as zeros.
            content = content[:end] + bytes(max(end - len(content), 0))
        content[step.offset : end] = step.data
    return bytes(content)
