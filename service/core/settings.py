"""Settings: from the command line, the environment (`PLACECELL_LIMITS__K`, ...) or a file."""

import difflib
import os
import re
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Literal, TypeGuard

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    SecretStr,
    field_validator,
    model_validator,
)
from pydantic_settings import (
    BaseSettings,
    EnvSettingsSource,
    InitSettingsSource,
    PydanticBaseSettingsSource,
    SettingsConfigDict,
)

from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER

MEBIBYTE = 1 << 20
GIBIBYTE = 1 << 30

NAMED_MAPS = 1_000
"""Largest number of maps that a request names, in any settings."""

PREFIX = "PLACECELL_"
FILE_VARIABLE = PREFIX + "CONFIG"
DEFAULT_FILE = "placecell.toml"

OTHER_NAMES = {
    FILE_VARIABLE: "settings file",
    PREFIX + "URL": "'placecell maps': address of the service",
    PREFIX + "KEY": "'placecell maps': key to send",
    PREFIX + "REMOTE_KEY": "'placecell maps mirror': key to send to the remote service",
    PREFIX + "DEBUG": "'placecell': stack traces of unexpected errors",
    PREFIX + "TEST_STORE": "tests: `postgres` runs the tests of the service on PostgreSQL",
    PREFIX + "DRIVES": "tests: folder of recorded drives",
    PREFIX + "ROS_PYTHON": "tests: Python that has rclpy",
    "PLACECELL_CACHE": "`placecell`: folder that keeps trajectories of odometry. (default: "
    "`~/.cache/placecell`)",
}
"""Environment names that are not settings of the service, and their meaning."""

DATABASE_URL = re.compile(r"postgres(ql)?://")
"""Beginning of the URL of a database."""

SERVICE_LINK = re.compile(
    r"PLACECELL_([A-Z0-9_]+_)?"
    r"(SERVICE_HOST|SERVICE_PORT(_[A-Z0-9_]+)?|PORT_\d+_(TCP|UDP|SCTP)(_(PROTO|PORT|ADDR))?)"
)
"""Environment names that Kubernetes adds for a Service called `placecell...`."""
LINKED_PORT = re.compile(r"(tcp|udp|sctp)://", re.IGNORECASE)
"""Pattern of a value that Kubernetes sets, such as `PLACECELL_PORT=tcp://10.0.0.7:8000`."""


class Limits(BaseModel):
    """Limits on requests, maps and connections; `/info` shows them."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    body_bytes: int = Field(
        default=16 * MEBIBYTE, ge=1, description="Largest body of a request, bytes."
    )
    json_bytes: int = Field(
        default=40 * MEBIBYTE,
        ge=1,
        description="Largest JSON body of a recognition request, bytes. The default holds "
        "`points` points with all their digits. If only body_bytes is set, its value applies.",
    )
    map_bytes: int = Field(
        default=64 * MEBIBYTE, ge=1, description="Largest map file in one request, bytes."
    )
    upload_bytes: int = Field(
        default=512 * MEBIBYTE,
        ge=1,
        description="Largest map file that is uploaded in parts, bytes.",
    )
    unfinished_bytes: int = Field(
        default=2 * GIBIBYTE,
        ge=1,
        description="Largest size of all unfinished uploads in parts, on disk, bytes; one key may "
        "use half.",
    )
    scan_bytes: int = Field(
        default=40 * MEBIBYTE, ge=1, description="Largest point cloud file in one request, bytes."
    )
    scan_points: int = Field(
        default=1_000_000, ge=1, description="Largest number of points of a point cloud file."
    )
    segments: int = Field(
        default=1_000, ge=1, description="Largest number of segments or descriptors per request."
    )
    points: int = Field(default=500_000, ge=1, description="Largest number of points per request.")
    min_points: int = Field(
        default=10,
        ge=3,
        description="Smallest number of points per segment; fewer have no shape to describe. "
        "Models are trained on segments of 100 points or more.",
    )
    max_points: int = Field(
        default=50_000, ge=3, description="Largest number of points per segment."
    )
    reach: float = Field(
        default=1_000.0,
        gt=0,
        description="Largest distance from a segment's sensor position to its points, meters.",
    )
    spread: float = Field(
        default=10_000.0,
        gt=0,
        description="Largest distance from the median of the sensor positions to any of them, "
        "meters.",
    )
    k: int = Field(default=100, ge=1, description="Largest number of candidates per query.")
    batch: int = Field(
        default=256, ge=1, description="Largest number of segments per batch of the model."
    )
    requests: int = Field(
        default=32,
        ge=1,
        description="Largest number of recognition requests running or waiting; further ones get "
        "a 429. Clients (keys, or addresses without keys) share this number fairly.",
    )
    deadline: float = Field(
        default=10.0,
        gt=0,
        allow_inf_nan=False,
        description="Seconds that a recognition request may take. A request may ask for fewer with "
        "the header Placecell-Timeout.",
    )
    cost_seconds: float = Field(
        default=8.0,
        gt=0,
        allow_inf_nan=False,
        description="Largest estimated cost of a recognition request, seconds of one core; more "
        "gets a 413. /info lists the rates.",
    )
    body_seconds: float = Field(
        default=8.0,
        gt=0,
        allow_inf_nan=False,
        description="Seconds within which the body of a recognition request must arrive.",
    )
    uploads: int = Field(
        default=4,
        ge=1,
        description="Largest number of map uploads running or waiting; further ones get a 429.",
    )
    edits: int = Field(
        default=16,
        ge=1,
        description="Largest number of map edits running or waiting; further ones get a 429.",
    )
    reads: int = Field(
        default=64,
        ge=1,
        description="Largest number of reads of stored maps, versions, changes and lists running "
        "or waiting; further ones get a 429.",
    )
    read_seconds: float = Field(
        default=60.0,
        gt=0,
        allow_inf_nan=False,
        description="Seconds within which the answer to a read must be ready to send.",
    )
    bodies: int = Field(
        default=64, ge=1, description="Largest number of bodies that one client sends at once."
    )
    held_bytes: int = Field(
        default=256 * MEBIBYTE,
        ge=1,
        description="Largest size of all bodies in memory, bytes; one client may use half.",
    )
    answer_bytes: int = Field(
        default=1024 * MEBIBYTE,
        ge=1,
        description="Largest size of all large answers in progress, on disk, bytes; one client "
        "may use half.",
    )
    stall_seconds: float = Field(
        default=60.0,
        gt=0,
        allow_inf_nan=False,
        description="Seconds without progress after which a body or an answer is dropped.",
    )
    transfer_seconds: float = Field(
        default=3_600.0,
        gt=0,
        allow_inf_nan=False,
        description="Seconds within which a map, an edit or an answer must be transferred.",
    )
    named_maps: int = Field(
        default=NAMED_MAPS,
        ge=1,
        le=NAMED_MAPS,
        description="Largest number of maps that a request names.",
    )
    robot_segments: int = Field(
        default=2_000_000,
        ge=1,
        description="Largest number of segments of one robot over all maps.",
    )
    map_segments: int = Field(
        default=4_000_000, ge=1, description="Largest number of segments of a map."
    )
    map_robots: int = Field(
        default=1_000,
        ge=1,
        description="Largest number of robots with segments in a map, and of source maps of a "
        "merged map.",
    )
    maps: int = Field(default=20_000, ge=1, description="Largest number of stored maps.")
    key_maps: int = Field(
        default=15_000,
        ge=1,
        description="Largest number of maps that one key creates; without keys, all maps count "
        "for one key.",
    )
    map_stored_bytes: int = Field(
        default=4 * GIBIBYTE,
        ge=1,
        description="Largest size of a map in the store with its old versions, bytes. Above half "
        "of it, the service drops old versions.",
    )
    stored_bytes: int = Field(
        default=64 * GIBIBYTE,
        ge=1,
        description="Largest size of all maps in the store with their old versions, bytes. Above "
        "three quarters of it, the service drops old versions.",
    )
    reserved_ids: int = Field(
        default=2_000_000,
        ge=1,
        description="Largest number of ids of a map that a key reserved within a week and has not "
        "written.",
    )
    upload_seconds: float = Field(
        default=120.0,
        gt=0,
        allow_inf_nan=False,
        description="Seconds within which a map or an edit must be stored after its last byte.",
    )
    alignments: int = Field(
        default=2,
        ge=1,
        description="Largest number of alignments and merges at once; further ones get a 429.",
    )
    alignment_seconds: float = Field(
        default=300.0,
        gt=0,
        allow_inf_nan=False,
        description="Seconds that an alignment or a merge may take.",
    )
    merged_maps: int = Field(
        default=12,
        ge=2,
        description="Largest number of maps in a merge; every pair of them is aligned.",
    )
    sessions: int = Field(
        default=10_000,
        ge=1,
        description="Largest number of `/localize` sessions in memory. Beyond it, the key with "
        "the most sessions loses its longest idle one.",
    )
    map_anchors: int = Field(
        default=1_000, ge=1, description="Largest number of named anchors of a map."
    )
    annotations: int = Field(
        default=100_000,
        ge=1,
        description="Largest number of tags and anchors of all maps together.",
    )
    robots: int = Field(
        default=10_000,
        ge=1,
        description="Largest number of robots whose last report is in memory. Beyond it, the key "
        "with the most robots loses its oldest one.",
    )
    robot_seconds: float = Field(
        default=3_600.0,
        gt=0,
        allow_inf_nan=False,
        description="Seconds after its last report when a robot is dropped from the list.",
    )
    events: int = Field(
        default=1_000, ge=1, description="Number of the last events that `/events` can repeat."
    )
    event_clients: int = Field(
        default=100,
        ge=1,
        description="Largest number of streams of events; further ones get a 429. One client may "
        "have a quarter.",
    )
    connections: int = Field(
        default=1_000,
        ge=1,
        description="Largest number of connections. A further one closes the connection that is "
        "idle longest.",
    )
    address_connections: int = Field(
        default=256,
        ge=1,
        description="Largest number of connections from one address; raise it behind a proxy.",
    )

    @model_validator(mode="before")
    @classmethod
    def _bound_json(cls, given: object) -> object:
        """Apply `body_bytes` to JSON if `json_bytes` is not set, as earlier versions did."""
        if isinstance(given, dict) and "body_bytes" in given and "json_bytes" not in given:
            return {**given, "json_bytes": given["body_bytes"]}
        return given


class Settings(BaseSettings):
    """Settings of the service; all defaults work in a checkout."""

    model_config = SettingsConfigDict(
        env_prefix=PREFIX,
        env_nested_delimiter="__",
        frozen=True,
        extra="forbid",
        hide_input_in_errors=True,  # a value may hold a password
    )

    data_dir: Path = Field(
        default=Path("var"), description="Folder of the stored maps; only one service may use it."
    )
    database: SecretStr = Field(
        default=SecretStr(""),
        description="Database of the stored maps: postgresql://USER:PASSWORD@HOST:PORT/DATABASE, "
        "which several services may use. If it is empty, the maps are in the data directory.",
    )
    loaded_segments: int = Field(
        default=0,
        ge=0,
        description="Number of segments to keep in memory; 0 keeps all. Beyond it, the maps that "
        "were used least recently leave the memory, and a request for one of them loads it again. "
        "A segment takes about 100 bytes.",
    )
    maps: tuple[str, ...] = Field(
        default=(),
        description="Patterns of the names of the maps to load, as a JSON list, such as "
        '["site-*"]; requests for other maps get a 404. If it is empty, all maps are loaded.',
    )
    reads: Literal["followed", "latest"] = Field(
        default="followed",
        description="Versions that a service with a database answers from: those in memory, which "
        "follow the database within milliseconds (followed), or the newest ones, which costs each "
        "request a query (latest).",
    )
    models_dir: Path = Field(
        default=MODELS_FOLDER, description="Folder that holds one folder per model."
    )
    model: str = Field(
        default=DEFAULT_MODEL,
        pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]*$",
        description="Name of the default model.",
    )
    also: tuple[str, ...] = Field(
        default=(), description="Names of further models to load, as a JSON list."
    )
    keys_file: Path | None = Field(
        default=None,
        description="TOML file of keys, made by `placecell keys`. Without it, every client may do "
        "everything.",
    )
    host: str = Field(default="127.0.0.1", description="Address to listen on.")
    port: int = Field(
        default=8000, ge=0, le=65_535, description="Port to listen on; 0 takes any free port."
    )
    unix_socket: Path | None = Field(
        default=None, description="Path of a Unix socket to listen on instead of host and port."
    )
    root_path: str = Field(
        default="",
        pattern=r"^(/[A-Za-z0-9._~-]+)*$",
        description="Path prefix that a proxy puts before the paths of the service, such as "
        "/placecell.",
    )
    forwarded_allow_ips: tuple[str, ...] = Field(
        default=(),
        description="Addresses or networks of proxies whose X-Forwarded-For and -Proto headers "
        "the service trusts, as a JSON list.",
    )
    keep_alive_seconds: int = Field(
        default=5, ge=1, description="Seconds that an idle connection stays open between requests."
    )
    cors_origins: tuple[str, ...] = Field(
        default=(),
        description="Origins of web pages that may call the service from a browser, as a JSON "
        'list; ["*"] allows all.',
    )
    allowed_hosts: tuple[str, ...] = Field(
        default=(),
        description="Host names that a service without keys accepts beside loopback names, as a "
        "JSON list; *.example matches all names below it, * matches all.",
    )
    docs: bool = Field(
        default=True, description="Serve the API documentation at /docs, /redoc and /openapi.json."
    )
    page: bool = Field(default=True, description="Serve the operator's page at / and /page.")
    workers: int = Field(
        default=2,
        ge=1,
        description="Number of threads that decode and search requests, beside those of the model.",
    )
    threads: int = Field(
        default=0, ge=0, description="Number of cores that a model uses; 0 uses all cores."
    )
    drain_seconds: float = Field(
        default=2.0,
        ge=0,
        description="Seconds after SIGTERM during which /readyz fails before the service refuses "
        "connections.",
    )
    log: Literal["json", "text"] = Field(default="text", description="Format of log lines.")
    limits: Limits = Field(default=Limits(), description="Limits of the service.")

    @field_validator("database")
    @classmethod
    def _check_database(cls, given: SecretStr) -> SecretStr:
        # The error shows nothing of the value, which may hold a password.
        if given.get_secret_value() and not DATABASE_URL.match(given.get_secret_value()):
            raise ValueError(
                "the URL of a database must begin with postgresql:// , such as "
                "postgresql://USER:PASSWORD@HOST:5432/placecell. Leave it empty for SQLite"
            )
        return given

    @classmethod
    def settings_customise_sources(
        cls,
        settings_cls: type[BaseSettings],
        init_settings: PydanticBaseSettingsSource,
        env_settings: PydanticBaseSettingsSource,
        dotenv_settings: PydanticBaseSettingsSource,
        file_secret_settings: PydanticBaseSettingsSource,
    ) -> tuple[PydanticBaseSettingsSource, ...]:
        """Order the sources: arguments, then the environment, then the file.

        Raises:
            ValueError: the environment or the file has a name that is not a setting.
        """
        del dotenv_settings, file_secret_settings
        environment = {
            name: value for name, value in os.environ.items() if not is_service_link(name, value)
        }
        check_environment(settings_cls, environment)
        if isinstance(env_settings, EnvSettingsSource):
            env_settings.env_vars = {
                name: value
                for name, value in env_settings.env_vars.items()
                if not is_service_link(name, value or "")
            }
        file = settings_file()
        content = read_settings(file)
        check_keys(settings_cls, content, file)
        return init_settings, env_settings, InitSettingsSource(settings_cls, content)


def is_service_link(name: str, value: str) -> bool:
    """Return whether Kubernetes set this name for a Service, and the name is not a setting."""
    name = name.upper()
    if SERVICE_LINK.fullmatch(name):
        return True
    return (
        name.startswith(PREFIX)
        and name.endswith("_PORT")
        and LINKED_PORT.match(value.strip()) is not None
    )


def is_group(kind: object) -> TypeGuard[type[BaseModel]]:
    """Return whether a setting is a group of settings."""
    return isinstance(kind, type) and issubclass(kind, BaseModel)


def variables(model: type[BaseModel], inside: str = PREFIX) -> Iterator[str]:
    """Yield the environment names of all settings and groups."""
    for name, field in model.model_fields.items():
        yield inside + name.upper()
        if is_group(field.annotation):
            yield from variables(field.annotation, f"{inside}{name.upper()}__")


def check_environment(model: type[BaseModel], environment: Mapping[str, str]) -> None:
    """Check that all names with the prefix are settings, so that typing errors are noticed.

    Raises:
        ValueError: a name is not a setting; the message names the nearest setting.
    """
    known = [*variables(model), *OTHER_NAMES]
    wrong = [
        f"{name}{nearest(name.upper(), known)}"
        for name in sorted(environment)
        if name.upper().startswith(PREFIX.rstrip("_")) and name.upper() not in known
    ]
    if wrong:
        raise ValueError(
            f"The environment has unknown settings: {', '.join(wrong)}. Unset them. "
            "'placecell config' lists all settings."
        )


def check_keys(model: type[BaseModel], content: Mapping[str, Any], file: Path) -> None:
    """Check that all keys of the file are settings.

    Raises:
        ValueError: a key is not a setting; the message names the nearest setting.
    """
    wrong = list(unknown_keys(model, content))
    if wrong:
        raise ValueError(
            f"{file}: unknown settings {', '.join(wrong)}. 'placecell config' lists all settings."
        )


def unknown_keys(
    model: type[BaseModel], content: Mapping[str, Any], inside: str = ""
) -> Iterator[str]:
    """Yield the keys that are not settings, each with the nearest setting."""
    for name, value in content.items():
        field = model.model_fields.get(name)
        if field is None:
            yield f"{inside}{name}{nearest(name, list(model.model_fields))}"
        elif isinstance(value, dict) and is_group(field.annotation):
            yield from unknown_keys(field.annotation, value, f"{inside}{name}.")


def nearest(name: str, known: list[str]) -> str:
    """Return a question that suggests the most similar name; empty if none is similar."""

    def bare(text: str) -> str:
        return re.sub(r"[^a-z0-9]", "", text.lower())

    by_letters = {bare(each): each for each in known}
    found = difflib.get_close_matches(bare(name), list(by_letters), 1, cutoff=0.7)
    return f" (did you mean {by_letters[found[0]]}?)" if found else ""


def read_settings(file: Path) -> dict[str, Any]:
    """Return the content of the settings file; empty if there is none.

    Raises:
        ValueError: the file cannot be read or is not valid TOML.
    """
    try:
        return tomllib.loads(file.read_text(encoding="utf-8-sig"))
    except FileNotFoundError:
        return {}
    except OSError as error:
        raise ValueError(f"{file}: cannot be read ({error.strerror})") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ValueError(f"{file}: is not valid TOML ({error})") from error


def settings_file() -> Path:
    """Return the path of the settings file, even if it does not exist.

    Raises:
        ValueError: the environment names a file that does not exist.
    """
    named = os.environ.get(FILE_VARIABLE)
    if named and not Path(named).is_file():
        raise ValueError(
            f"{FILE_VARIABLE} names {named}, which is not a file. Correct the path or unset it."
        )
    return Path(named or DEFAULT_FILE)
