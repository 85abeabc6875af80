"""The files for replicas agree with each other, with the service, and with haproxy."""

import re
import subprocess
from pathlib import Path
from shutil import which
from typing import Any

import pytest
import yaml

from service.api.middleware.request_log import ID_PATTERN
from service.app import create_app
from service.core.settings import Settings
from service.maps.stores import OTHER_CONNECTIONS
from tests.deploy.test_deploy import (
    COMPOSED,
    CONTAINER,
    DEPLOY,
    PROJECT,
    image_environment,
    is_setting,
    seconds,
)

FLEET = DEPLOY / "fleet"
COMPOSE: dict[str, Any] = yaml.safe_load((FLEET / "compose.yaml").read_text())
SERVICES: dict[str, dict[str, Any]] = COMPOSE["services"]
REPLICAS = [name for name in SERVICES if name.startswith("replica-")]
DATABASES = [name for name in SERVICES if name.startswith("postgres-")]
KUBERNETES = {
    each["kind"]: each for each in yaml.safe_load_all((FLEET / "kubernetes.yaml").read_text())
}
POD = KUBERNETES["Deployment"]["spec"]["template"]
REPLICA = POD["spec"]["containers"][0]
FLEET_DOCS = (DEPLOY.parent / "docs" / "how-to" / "fleet.md").read_text()
HAPROXY = (FLEET / "haproxy.cfg").read_text()


def haproxy_seconds(name: str) -> float:
    """Return a timeout of haproxy.cfg."""
    value = re.search(rf"^\s+timeout {name} (\d+)(ms|s)$", HAPROXY, re.MULTILINE)
    assert value is not None
    return float(value[1]) / {"s": 1, "ms": 1000}[value[2]]


def composed_environment(monkeypatch: pytest.MonkeyPatch) -> Settings:
    """Return the settings of a composed replica."""
    for name, value in (image_environment() | SERVICES["replica-1"]["environment"]).items():
        monkeypatch.setenv(name, re.sub(r"\$\{(\w+):?[^}]*\}", "secret", value))
    return Settings.model_validate({})


def test_three_replicas_are_alike() -> None:
    assert len(REPLICAS) == 3
    assert all(SERVICES[name] == SERVICES[REPLICAS[0]] for name in REPLICAS)
    assert SERVICES[REPLICAS[0]]["image"] == COMPOSED["image"]
    assert REPLICA["image"] == f"placecell:{PROJECT['project']['version']}"


def test_composed_replicas_have_settings_that_exist(monkeypatch: pytest.MonkeyPatch) -> None:
    settings = composed_environment(monkeypatch)
    grace = seconds(SERVICES["replica-1"]["stop_grace_period"])

    assert grace > settings.drain_seconds + settings.limits.deadline + 5
    assert settings.threads == SERVICES["replica-1"]["cpus"]


def test_pods_have_settings_that_exist() -> None:
    variables = {each["name"]: each.get("value") for each in REPLICA["env"]}
    assert all(is_setting(name) for name in variables)
    assert variables["PLACECELL_THREADS"] == REPLICA["resources"]["limits"]["cpu"]


def test_replicas_find_both_servers_of_the_database() -> None:
    url = SERVICES["replica-1"]["environment"]["PLACECELL_DATABASE"]
    hosts = re.search(r"@([^/]+)/placecell\?", url)
    assert hosts is not None
    assert hosts[1].split(",") == DATABASES
    # After a failover the connection goes to the server that takes writes.
    assert "target_session_attrs=read-write" in url
    text = (FLEET / "replica.conf").read_text()
    assert "target_session_attrs=read-write" in text


def test_standby_copies_the_first_server() -> None:
    assert DATABASES == ["postgres-1", "postgres-2"]
    script, primary = SERVICES["postgres-2"]["entrypoint"]
    mounts = [mount for name in DATABASES for mount in SERVICES[name]["volumes"]]
    files = {target: source for source, target in (mount.split(":")[:2] for mount in mounts)}
    assert primary == "postgres-1"
    assert (FLEET / files[script]).is_file()
    for source, target in ((mount.split(":")[0], mount) for mount in mounts):
        assert (FLEET / source).is_file() if source[0] == "." else source in COMPOSE["volumes"], (
            target
        )


def test_interrupted_copy_of_the_primary_is_made_anew(tmp_path: Path) -> None:
    programs = tmp_path / "bin"
    programs.mkdir()
    for name, lines in {
        "chown": "",
        "gosu": 'shift; exec "$@"',
        "hostname": "echo db-2",
        "docker-entrypoint.sh": 'echo "started $*"',
        "pg_basebackup": 'mkdir "$2" && echo 18 > "$2/PG_VERSION" && [ ! -e "$FAULT" ] '
        '&& touch "$2/standby.signal"',
    }.items():
        (programs / name).write_text(f"#!/bin/sh\n{lines}\n")
        (programs / name).chmod(0o755)
    data, fault = tmp_path / "18" / "docker", tmp_path / "fault"
    environment = {
        "PATH": f"{programs}:/usr/bin:/bin",
        "PGDATA": str(data),
        "PGPASSWORD": "secret",
        "FAULT": str(fault),
    }

    def start(primary: str) -> str:
        done = subprocess.run(
            ["sh", str(FLEET / "postgres" / "standby.sh"), primary, "postgres", "-c", "x=1"],
            env=environment,
            capture_output=True,
            text=True,
            check=False,
            timeout=60,
        )
        return done.stdout

    assert start("") == "started postgres -c x=1\n"
    assert not data.exists()
    fault.touch()
    assert start("postgres-1") == ""
    assert not data.exists()
    fault.unlink()
    for _ in range(2):
        assert start("postgres-1") == "started postgres -c x=1\n"
        assert sorted(each.name for each in data.iterdir()) == [
            "PG_VERSION",
            "postgresql.auto.conf",
            "standby.signal",
        ]


def test_commit_waits_for_the_standby() -> None:
    assert "synchronous_commit=on" in SERVICES["postgres-1"]["command"]
    script = (FLEET / "postgres/allow-standby.sh").read_text()
    assert "synchronous_standby_names = 'ANY 1 (*)'" in script
    cluster = KUBERNETES["Cluster"]["spec"]
    synchronous = cluster["postgresql"]["synchronous"]
    assert synchronous == {"method": "any", "number": 1, "dataDurability": "required"}
    # Two standbys, so that writes go on while one of them is away.
    assert cluster["instances"] == 3


def test_only_the_balancer_has_a_port() -> None:
    ports = {name: each["ports"] for name, each in SERVICES.items() if "ports" in each}
    assert ports == {"balancer": ["127.0.0.1:8000:8000"]}
    assert re.search(r"^\s+bind :8000$", HAPROXY, re.MULTILINE)


def test_no_privileges() -> None:
    for name, service in SERVICES.items():
        assert service["cap_drop"] == ["ALL"], name
        assert service["security_opt"] == ["no-new-privileges:true"], name
    for key in ("securityContext",):
        assert REPLICA[key] == CONTAINER[key]
    assert POD["spec"]["securityContext"]["runAsNonRoot"] is True
    assert POD["spec"]["enableServiceLinks"] is False


def test_balancer_knows_the_replicas() -> None:
    servers = re.findall(r"^\s+server (\S+) (\S+):(\d+)$", HAPROXY, re.MULTILINE)
    assert servers == [(name, name, "8000") for name in REPLICAS]
    tracked = re.findall(r"^\s+server (\S+) (\S+):8000 track replicas/(\S+)", HAPROXY, re.MULTILINE)
    assert tracked == [(name, name, name) for name in REPLICAS] * 2  # of sessions and uploads
    assert SERVICES["balancer"]["volumes"] == [
        "./haproxy.cfg:/usr/local/etc/haproxy/haproxy.cfg:ro"
    ]


def test_balancer_checks_a_route_that_exists() -> None:
    (path,) = re.findall(r"http-check send meth GET uri (\S+)", HAPROXY)
    searches = {*re.findall(r"acl is_search path_beg (.+)$", HAPROXY, re.MULTILINE)}
    assert len(searches) == 1
    paths = create_app(Settings.model_validate({})).openapi()["paths"]
    assert path == "/readyz"
    assert {path, *searches.pop().split()} <= set(paths)


def test_balancer_repeats_only_requests_that_change_nothing() -> None:
    assert HAPROXY.count("http-request disable-l7-retry unless METH_GET or is_search") == 2
    causes = re.findall(r"retry-on (.+)", HAPROXY)
    assert causes == ["conn-failure empty-response"] * 2


def test_balancer_and_replica_log_the_same_id() -> None:
    found = re.search(r"unless \{ req\.hdr\(X-Request-Id\) -m reg \^(\S+)\$ \}", HAPROXY)
    assert found is not None
    assert found[1] == ID_PATTERN.pattern


def test_balancer_waits_longer_than_the_service(monkeypatch: pytest.MonkeyPatch) -> None:
    settings = composed_environment(monkeypatch)
    assert haproxy_seconds("server") > settings.limits.alignment_seconds
    assert haproxy_seconds("client") > settings.limits.stall_seconds
    assert haproxy_seconds("http-keep-alive") < settings.keep_alive_seconds


def test_balancer_sees_a_draining_replica_in_time(monkeypatch: pytest.MonkeyPatch) -> None:
    settings = composed_environment(monkeypatch)
    every, fast, fall = re.findall(r"inter (\d+)ms fastinter (\d+)ms .* fall (\d+)", HAPROXY)[0]
    assert settings.drain_seconds > (int(every) + (int(fall) - 1) * int(fast)) / 1000


def test_haproxy_accepts_the_file() -> None:
    haproxy = which("haproxy") or "/usr/sbin/haproxy"
    if not Path(haproxy).exists():
        pytest.skip("haproxy is not installed; on Debian: apt-get install haproxy")
    done = subprocess.run(
        [haproxy, "-c", "-f", str(FLEET / "haproxy.cfg")],
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
    )
    assert done.returncode == 0, done.stderr
    # Outside of the network of compose.yaml, the names of the replicas are unknown.
    warnings = [line for line in done.stderr.splitlines() if "[WARNING]" in line]
    assert all("could not resolve address 'replica-" in line for line in warnings), warnings


def test_replicas_are_not_stopped_all_at_once() -> None:
    deployment = KUBERNETES["Deployment"]["spec"]
    budget = KUBERNETES["PodDisruptionBudget"]["spec"]
    scaler = KUBERNETES["HorizontalPodAutoscaler"]["spec"]
    labels = POD["metadata"]["labels"]

    assert deployment["strategy"]["rollingUpdate"]["maxUnavailable"] == 0
    assert budget["maxUnavailable"] == 1
    assert scaler["minReplicas"] == 3
    assert scaler["scaleTargetRef"]["name"] == KUBERNETES["Deployment"]["metadata"]["name"]
    assert deployment["selector"]["matchLabels"] == budget["selector"]["matchLabels"] == labels
    assert KUBERNETES["Service"]["spec"]["selector"] == labels
    # The autoscaler alone sets the number of replicas.
    assert "replicas" not in deployment


def test_database_has_connections_for_all_replicas() -> None:
    limits = Settings().limits
    # One more listens.
    each = limits.uploads + limits.alignments + OTHER_CONNECTIONS + 1
    assert "Each replica takes up to 21 connections" in FLEET_DOCS
    assert each == 21
    scaler = KUBERNETES["HorizontalPodAutoscaler"]["spec"]
    surge = KUBERNETES["Deployment"]["spec"]["strategy"]["rollingUpdate"]["maxSurge"]
    parameters = KUBERNETES["Cluster"]["spec"]["postgresql"]["parameters"]
    others = 20  # the operator, the standbys, backups
    assert int(parameters["max_connections"]) >= each * (scaler["maxReplicas"] + surge) + others
    assert each * len(REPLICAS) + others <= 100  # PostgreSQL's default


def test_pods_get_the_database_of_the_cluster() -> None:
    variable = next(each for each in REPLICA["env"] if each["name"] == "PLACECELL_DATABASE")
    cluster = KUBERNETES["Cluster"]["metadata"]["name"]
    # CloudNativePG writes this secret for the owner of the database.
    assert variable["valueFrom"]["secretKeyRef"] == {"name": f"{cluster}-app", "key": "uri"}


def test_probes_are_those_of_one_pod_with_time_to_load() -> None:
    for name in ("readinessProbe", "livenessProbe"):
        assert REPLICA[name] == CONTAINER[name]
    startup = REPLICA["startupProbe"]
    assert startup["periodSeconds"] * startup["failureThreshold"] >= 600


def test_volumes_of_a_pod_are_mounted() -> None:
    volumes = {volume["name"] for volume in POD["spec"]["volumes"]}
    assert {mount["name"] for mount in REPLICA["volumeMounts"]} == volumes


def test_image_can_reach_the_database() -> None:
    dockerfile = (DEPLOY.parent / "Dockerfile").read_text()
    assert "--requirement requirements/fleet.txt" in dockerfile
    assert "\npsycopg[binary]==" in (DEPLOY.parent / "requirements/fleet.txt").read_text()
