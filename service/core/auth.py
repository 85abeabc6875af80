"""Authentication: keys, their principals and scopes.

A file lists each key by its SHA-256; the key itself is shown once, when it is made. The file is
read again when it has changed. While the file cannot be read, a key whose hash still stands in it
keeps working; any other key works for one more minute, because a file that is being edited may be
incomplete for a moment.

    [robot-7]
    sha256 = "9f86d081884c7d65..."
    write = true
    maps = ["yard", "hall-*"]
    robot = "robot-7"
"""

import hashlib
import hmac
import logging
import re
import secrets
import tomllib
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path
from time import monotonic

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

from service.core.problems import Problem

PREFIX = "placecell_"
"""Prefix of every key, which makes keys in files and logs easy to find."""

GRACE_SECONDS = 60.0
"""Seconds for which a key that was removed from an unreadable file still works."""

logger = logging.getLogger("placecell")


class Key(BaseModel):
    """Key and its scope: the maps and operations that it allows."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    sha256: str = Field(pattern=r"^[0-9a-f]{64}$", description="SHA-256 digest of the key, hex.")
    write: bool = Field(default=False, description="True if the key may write maps.")
    admin: bool = Field(
        default=False, description="True if the key may reload models and free ids."
    )
    maps: tuple[str, ...] = Field(
        default=("*",), description="Patterns of map names, with * and ?."
    )
    robot: str | None = Field(
        default=None, description="If set, the key may write only segments of this robot."
    )


@dataclass(frozen=True, slots=True)
class Principal:
    """Principal: name and scope of the key that sent a request."""

    name: str
    key: Key

    def check_map(self, name: str) -> None:
        """Raise a problem (403) unless the scope includes a map."""
        if not self.covers(name):
            raise Problem(403, "forbidden", f"This key has no access to the map {name!r:.80}.")

    def covers(self, name: str) -> bool:
        """Return whether the scope includes a map."""
        return any(fnmatchcase(name, pattern) for pattern in self.key.maps)

    @property
    def covers_all(self) -> bool:
        """Return whether the scope includes every map, future ones too."""
        return "*" in self.key.maps

    def check_write(self, name: str) -> None:
        """Raise a problem (403) unless the key may write a map."""
        self.check_map(name)
        if not self.key.write:
            raise Problem(403, "forbidden", "This key may read maps, but not write them.")

    def check_robots(self, robots: Iterable[str]) -> None:
        """Raise a problem (403) unless the key may write segments of these robots."""
        if self.key.robot is not None and {*robots} - {self.key.robot}:
            raise self._own_alone()

    def check_reports(self, robot: str) -> None:
        """Raise a problem (403) unless the key may report the pose of this robot.

        A key that is bound to a robot reports this robot; any other key needs write access.
        """
        if self.key.robot is None and not self.key.write:
            raise Problem(
                403,
                "forbidden",
                "This key may read maps, but not report robots. Use a key with write access, or "
                "one that is bound to the robot.",
            )
        if self.key.robot not in (None, robot):
            raise Problem(
                403, "forbidden", f"This key may report only the robot {self.key.robot!r:.80}."
            )

    def check_all(self) -> None:
        """Raise a problem (403) unless the key may write segments of all robots."""
        if self.key.robot is not None:
            raise self._own_alone()

    def check_admin(self) -> None:
        """Raise a problem (403) unless the key may administer the service."""
        if not self.key.admin:
            raise Problem(403, "forbidden", "This key may not administer the service.")

    def _own_alone(self) -> Problem:
        return Problem(
            403,
            "forbidden",
            f"This key may write only segments of the robot {self.key.robot!r:.80}.",
        )


ANYONE = Principal("anyone", Key(sha256="0" * 64, write=True, admin=True))
"""Principal of all requests if the service has no keys."""

KEYS = TypeAdapter(dict[str, Key])


class Keys:
    """Keys of a file; without a file every client may do everything."""

    def __init__(self, file: Path | None, clock: Callable[[], float] = monotonic) -> None:
        """Read the keys.

        Args:
            file: the file of keys; None for a service without keys.
            clock: monotonic clock, seconds.

        Raises:
            ValueError: the file is missing or is not a file of keys.
        """
        self._file = file
        self._mark = _mark(file)
        self._principals = read_keys(file) if file else []
        self._clock = clock
        self._bad_since: float | None = None
        self._standing: frozenset[str] = frozenset()

    def __bool__(self) -> bool:
        return self._file is not None

    @property
    def patterns(self) -> tuple[tuple[str, ...], ...]:
        """Return the distinct lists of map name patterns of all keys."""
        return tuple(sorted({principal.key.maps for principal in self._principals}))

    def principal(self, authorization: str | None) -> Principal:
        """Return the principal of a request with this Authorization header.

        Raises:
            Problem: 401, the header holds no known key.
        """
        if self._file is None:
            return ANYONE
        self.is_good()
        scheme, _, token = (authorization or "").partition(" ")
        digest = hashlib.sha256(token.strip().encode()).hexdigest()
        found = None
        # All keys are compared, each in constant time, so that the time reveals nothing.
        for principal in self._principals:
            if hmac.compare_digest(principal.key.sha256, digest):
                found = principal
        if found is None or scheme.lower() != "bearer" or not self._works(found):
            raise Problem(
                401,
                "unauthorized",
                "The request needs a known key in the header Authorization: Bearer KEY.",
                headers={"WWW-Authenticate": "Bearer"},
            )
        return found

    def is_good(self) -> bool:
        """Read the file again if it has changed; return whether it is readable."""
        mark = _mark(self._file)
        if self._file is not None and mark != self._mark:
            try:
                self._principals = read_keys(self._file)
            except ValueError as error:
                if self._bad_since is None:
                    self._bad_since = self._clock()
                self._standing = _hashes_in(self._file)
                logger.error(
                    "%s; keys whose hash is still in the file keep working, all others work for "
                    "%g s more",
                    error,
                    GRACE_SECONDS,
                )
            else:
                if self._bad_since is not None:
                    logger.warning("the key file is readable again")
                self._bad_since = None
            self._mark = mark
        return self._bad_since is None

    def any_works(self) -> bool:
        """Return whether any key can be accepted; see `is_good`."""
        return self._file is None or any(self._works(principal) for principal in self._principals)

    def _works(self, principal: Principal) -> bool:
        """Return whether a key of the last readable file still works."""
        if self._bad_since is None or principal.key.sha256 in self._standing:
            return True
        return self._clock() - self._bad_since <= GRACE_SECONDS


def read_keys(file: Path) -> list[Principal]:
    """Read the principals of a file of keys.

    Raises:
        ValueError: the file is missing or is not a file of keys; the message shows no content.
    """
    try:
        keys = KEYS.validate_python(tomllib.loads(file.read_text(encoding="utf-8-sig")))
    except OSError as error:
        raise ValueError(f"{file}: cannot be read ({error.strerror})") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ValueError(f"{file}: is not valid TOML ({type(error).__name__})") from error
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(map(str, first["loc"]))
        raise ValueError(f"{file}: {where}: {first['msg']}") from error
    return [Principal(name, key) for name, key in keys.items()]


def _hashes_in(file: Path) -> frozenset[str]:
    """Return the hashes in a file that cannot be read as keys, without its comments."""
    try:
        text = file.read_bytes().decode(errors="replace")
    except OSError:
        return frozenset()
    lines = [line.partition("#")[0] for line in text.splitlines()]
    return frozenset(re.findall(r"[0-9a-f]{64}", "\n".join(lines)))


def new_key() -> tuple[str, str]:
    """Return a new key and its SHA-256 digest in hex."""
    key = PREFIX + secrets.token_urlsafe(32)
    return key, hashlib.sha256(key.encode()).hexdigest()


def _mark(file: Path | None) -> tuple[int, ...] | None:
    """Return a value that changes when the file does."""
    try:
        status = file.stat() if file else None
    except OSError:
        return None
    if status is None:
        return None
    return status.st_mtime_ns, status.st_ctime_ns, status.st_ino, status.st_size
