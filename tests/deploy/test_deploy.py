"""The ways of running the service agree with each other and with the service."""

import json
import re
import subprocess
import sys
import threading
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path
from typing import Any

import pytest
import yaml

from service.app import create_app
from service.core.settings import Settings

ROOT = Path(__file__).resolve().parents[2]
DEPLOY = ROOT / "deploy"
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
FILES = [ROOT / "Dockerfile", *(file for file in DEPLOY.rglob("*") if file.is_file())]
KEYS_OF_COMPOSE = "PLACECELL_KEYS"
"""Where compose.yaml finds the file of keys; not seen by the service."""
Pairs = list[tuple[str, str]]


def dockerfile() -> Pairs:
    """Instructions with what follows them, of the last stage."""
    text = re.sub(r"^#.*\n", "", (ROOT / "Dockerfile").read_text(), flags=re.MULTILINE)
    lines = re.sub(r"\\\n\s*", "", text).splitlines()
    pairs = [(name, rest) for name, _, rest in (line.partition(" ") for line in lines) if name]
    last = max(number for number, (name, _) in enumerate(pairs) if name == "FROM")
    return pairs[last:]


def unit() -> Pairs:
    """Settings of the systemd unit; a name may come more than once."""
    lines = (DEPLOY / "placecell.service").read_text().splitlines()
    return [
        (n, v) for n, mark, v in (line.partition("=") for line in lines) if mark and n[0] != "#"
    ]


def documents(name: str) -> list[dict[str, Any]]:
    return [document for document in yaml.safe_load_all((DEPLOY / name).read_text()) if document]


def values(pairs: Pairs, name: str) -> list[str]:
    return [value for found, value in pairs if found == name]


COMPOSE = documents("compose.yaml")[0]
COMPOSED = COMPOSE["services"]["placecell"]
PROMETHEUS = documents("prometheus.yml")[0]
KUBERNETES = {document["kind"]: document for document in documents("kubernetes.yaml")}
POD = KUBERNETES["StatefulSet"]["spec"]["template"]
CONTAINER = POD["spec"]["containers"][0]


def image_environment() -> dict[str, str]:
    return dict(pair.split("=", 1) for text in values(dockerfile(), "ENV") for pair in text.split())


def unit_environment() -> dict[str, str]:
    return dict(text.split("=", 1) for text in values(unit(), "Environment"))


ENVIRONMENTS = {
    "image": image_environment(),
    "compose": image_environment() | COMPOSED["environment"],
    "kubernetes": image_environment() | {e["name"]: e["value"] for e in CONTAINER["env"]},
    "systemd": unit_environment(),
}


def seconds(text: str) -> float:
    return float(text.removesuffix("s"))


def settings_in(name: str, monkeypatch: pytest.MonkeyPatch) -> Settings:
    for variable, value in ENVIRONMENTS[name].items():
        monkeypatch.setenv(variable, value)
    return Settings.model_validate({})


def paths() -> set[str]:
    return set(create_app(Settings.model_validate({})).openapi()["paths"])


def is_setting(variable: str) -> bool:
    model: Any = Settings
    for part in variable.removeprefix("PLACECELL_").lower().split("__"):
        if part not in getattr(model, "model_fields", ()):
            return False
        model = model.model_fields[part].annotation
    return True


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.name)
def test_what_is_named_can_be_set(file: Path) -> None:
    named = set(re.findall(r"PLACECELL_[A-Z_]+", file.read_text()))

    assert not {name for name in named - {KEYS_OF_COMPOSE} if not is_setting(name)}


@pytest.mark.parametrize("name", ENVIRONMENTS)
def test_environments_are_settings(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    settings = settings_in(name, monkeypatch)

    assert settings.port == 8000
    assert str(settings.data_dir) == ENVIRONMENTS[name]["PLACECELL_DATA_DIR"]


@pytest.mark.parametrize("name", ENVIRONMENTS)
def test_what_runtime_tells_its_makers_is_off(name: str) -> None:
    assert ENVIRONMENTS[name]["ORT_DISABLE_TELEMETRY"] == "1"


def test_one_port() -> None:
    ports = CONTAINER["ports"][0]
    service = KUBERNETES["Service"]["spec"]["ports"][0]

    assert values(dockerfile(), "EXPOSE") == ["8000"]
    assert [port.rsplit(":", 1)[1] for port in COMPOSED["ports"]] == ["8000"]
    assert PROMETHEUS["scrape_configs"][0]["static_configs"][0]["targets"] == ["placecell:8000"]
    assert "placecell" in COMPOSE["services"]
    assert ports["containerPort"] == service["port"] == 8000
    assert ports["name"] == service["targetPort"]
    assert POD["metadata"]["annotations"]["prometheus.io/port"] == "8000"


def test_ports_are_published_to_this_machine_alone() -> None:
    for service in COMPOSE["services"].values():
        assert all(port.startswith("127.0.0.1:") for port in service["ports"])


def test_one_user_and_not_root() -> None:
    security = POD["spec"]["securityContext"]
    made = re.search(r"useradd --uid (\d+)", " ".join(values(dockerfile(), "RUN")))

    assert made is not None
    assert values(dockerfile(), "USER") == [f"{made[1]}:{made[1]}"]
    assert security["runAsUser"] == security["runAsGroup"] == security["fsGroup"] == int(made[1])
    assert security["runAsNonRoot"] is True
    assert values(unit(), "DynamicUser") == ["yes"]


def test_only_data_and_temporary_files_are_written() -> None:
    mounts = {mount["mountPath"]: mount for mount in CONTAINER["volumeMounts"]}
    claims = [
        c["metadata"]["name"] for c in KUBERNETES["StatefulSet"]["spec"]["volumeClaimTemplates"]
    ]
    image = image_environment()

    assert COMPOSED["read_only"] is True
    assert CONTAINER["securityContext"]["readOnlyRootFilesystem"] is True
    assert values(unit(), "ProtectSystem") == ["strict"]
    assert values(dockerfile(), "VOLUME") == [image["PLACECELL_DATA_DIR"]] == ["/data"]
    assert COMPOSED["volumes"] == ["maps:/data"]
    assert [mounts["/data"]["name"]] == claims
    assert image["NUMBA_CACHE_DIR"].startswith("/tmp/")
    assert [mount.split(":")[0] for mount in COMPOSED["tmpfs"]] == ["/tmp"]
    assert "/tmp" in mounts
    assert unit_environment()["PLACECELL_DATA_DIR"] == f"%S/{values(unit(), 'StateDirectory')[0]}"
    assert unit_environment()["NUMBA_CACHE_DIR"].startswith(
        f"%C/{values(unit(), 'CacheDirectory')[0]}/"
    )


def test_no_privileges() -> None:
    for service in COMPOSE["services"].values():
        assert service["cap_drop"] == ["ALL"]
        assert service["security_opt"] == ["no-new-privileges:true"]
    assert CONTAINER["securityContext"]["capabilities"] == {"drop": ["ALL"]}
    assert CONTAINER["securityContext"]["allowPrivilegeEscalation"] is False
    assert values(unit(), "CapabilityBoundingSet") == [""]
    assert values(unit(), "NoNewPrivileges") == ["yes"]


def test_keys_are_where_the_service_looks_for_them() -> None:
    mounts = {mount["name"]: mount["mountPath"] for mount in CONTAINER["volumeMounts"]}
    credential = values(unit(), "LoadCredential")[0].split(":")[0]
    secret = COMPOSED["secrets"][0]

    assert ENVIRONMENTS["compose"]["PLACECELL_KEYS_FILE"] == f"/run/secrets/{secret}"
    assert secret in COMPOSE["secrets"]
    assert ENVIRONMENTS["kubernetes"]["PLACECELL_KEYS_FILE"] == f"{mounts['keys']}/keys.toml"
    assert ENVIRONMENTS["systemd"]["PLACECELL_KEYS_FILE"] == f"%d/{credential}"


def test_nobody_is_let_in_without_a_key() -> None:
    for file in FILES:
        assert file.suffix == ".md" or "allow-remote" not in file.read_text(), file.name
    assert ENVIRONMENTS["systemd"]["PLACECELL_HOST"] == "127.0.0.1"


def test_one_process_owns_the_maps() -> None:
    assert KUBERNETES["StatefulSet"]["spec"]["replicas"] == 1
    assert "deploy" not in COMPOSED
    assert "scale" not in COMPOSED


def test_probes_ask_for_routes_that_exist() -> None:
    probes = [CONTAINER[f"{name}Probe"] for name in ("startup", "readiness", "liveness")]
    asked = {probe["httpGet"]["path"] for probe in probes}

    assert [probe["httpGet"]["port"] for probe in probes] == ["http"] * 3
    assert CONTAINER["livenessProbe"]["httpGet"]["path"] == "/livez"
    assert CONTAINER["readinessProbe"]["httpGet"]["path"] == "/readyz"
    scraped = PROMETHEUS["scrape_configs"][0]["metrics_path"]
    assert scraped == POD["metadata"]["annotations"]["prometheus.io/path"] == "/metrics"
    assert asked | {scraped} <= paths()


@pytest.mark.parametrize("name", ["compose", "kubernetes", "systemd"])
def test_there_is_time_to_answer_the_last_request(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    settings = settings_in(name, monkeypatch)
    grace = {
        "compose": COMPOSED["stop_grace_period"],
        "kubernetes": str(POD["spec"]["terminationGracePeriodSeconds"]),
        "systemd": values(unit(), "TimeoutStopSec")[0],
    }[name]

    assert seconds(grace) > settings.drain_seconds + settings.limits.deadline + 5


def test_the_pod_is_taken_out_while_it_drains() -> None:
    probe = CONTAINER["readinessProbe"]

    drain = float(ENVIRONMENTS["kubernetes"]["PLACECELL_DRAIN_SECONDS"])
    assert drain > probe["periodSeconds"] * probe["failureThreshold"]


def test_threads_are_the_cores_that_there_are() -> None:
    assert ENVIRONMENTS["compose"]["PLACECELL_THREADS"] == str(COMPOSED["cpus"])
    limits = CONTAINER["resources"]["limits"]
    assert ENVIRONMENTS["kubernetes"]["PLACECELL_THREADS"] == limits["cpu"]


def test_kubernetes_does_not_set_the_port() -> None:
    # A service called placecell makes PLACECELL_PORT=tcp://... in every pod that lets it.
    assert KUBERNETES["Service"]["metadata"]["name"] == "placecell"
    assert POD["spec"]["enableServiceLinks"] is False


def test_kubernetes_names_belong_together() -> None:
    labels = POD["metadata"]["labels"]
    stateful = KUBERNETES["StatefulSet"]["spec"]
    service = KUBERNETES["Service"]

    assert service["spec"]["selector"] == stateful["selector"]["matchLabels"] == labels
    assert stateful["serviceName"] == service["metadata"]["name"]
    volumes = {volume["name"] for volume in POD["spec"]["volumes"]}
    volumes |= {claim["metadata"]["name"] for claim in stateful["volumeClaimTemplates"]}
    assert {mount["name"] for mount in CONTAINER["volumeMounts"]} == volumes


def test_images_are_of_one_version() -> None:
    ours = f"placecell:{PROJECT['project']['version']}"
    readme = (ROOT / "docs" / "tutorials" / "deploy.md").read_text()

    assert COMPOSED["image"] == CONTAINER["image"] == ours
    assert set(re.findall(r"placecell:\d[\w.]*", readme)) == {ours}
    assert f"docker build -t {ours} ." in (ROOT / "Dockerfile").read_text()
    for service in COMPOSE["services"].values():
        assert re.search(r":v?\d+\.\d+\.\d+(@sha256:\w{64})?$", service["image"]), service["image"]


def test_compose_mounts_files_that_exist() -> None:
    for service in COMPOSE["services"].values():
        for mount in service["volumes"]:
            source = mount.split(":")[0]
            assert (DEPLOY / source).is_file() if source[0] == "." else source in COMPOSE["volumes"]


def test_grafana_finds_prometheus_and_the_dashboard() -> None:
    source = documents("grafana/datasource.yaml")[0]["datasources"][0]
    provider = documents("grafana/dashboards.yaml")[0]["providers"][0]
    mounts = dict(mount.split(":")[:2] for mount in COMPOSE["services"]["grafana"]["volumes"])

    assert source["url"] == "http://prometheus:9090"
    assert "prometheus" in COMPOSE["services"]
    assert source["jsonData"]["timeInterval"] == PROMETHEUS["global"]["scrape_interval"]
    assert Path(mounts["./dashboard.json"]).parent == Path(provider["options"]["path"])
    environment = COMPOSE["services"]["grafana"]["environment"]
    home = environment["GF_DASHBOARDS_DEFAULT_HOME_DASHBOARD_PATH"]
    assert home == mounts["./dashboard.json"]


def test_the_build_gets_what_it_needs_and_nothing_else() -> None:
    lines = (ROOT / ".dockerignore").read_text().splitlines()
    allowed = {line[1:] for line in lines if line.startswith("!")}
    packages = PROJECT["tool"]["hatch"]["build"]["targets"]["wheel"]["packages"]
    files = {*PROJECT["project"]["license-files"], PROJECT["project"]["readme"]}

    assert "*" in lines
    needed = {
        *packages,
        *files,
        "client",
        "models",
        "pyproject.toml",
        "constraints.txt",
        "requirements",
    }
    assert allowed == needed
    assert all((ROOT / name).exists() for name in allowed)


@contextmanager
def answering(status: int) -> Iterator[tuple[int, list[str]]]:
    """A server that answers so; its port, and the paths that were asked for."""
    asked = []

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            asked.append(self.path)
            self.send_response(status)
            self.end_headers()

        def log_request(self, code: int | str = "-", size: int | str = "-") -> None:
            pass

    with HTTPServer(("127.0.0.1", 0), Handler) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield server.server_port, asked
        server.shutdown()
        thread.join()


@pytest.mark.parametrize(("status", "code"), [(200, 0), (503, 1)])
def test_the_images_health_check_tells_ready_from_not(status: int, code: int) -> None:
    check = values(dockerfile(), "HEALTHCHECK")[0]
    python, *arguments = json.loads(check.partition("CMD ")[2])

    with answering(status) as (port, asked):
        environment = {"PLACECELL_PORT": str(port)}
        done = subprocess.run([sys.executable, *arguments], env=environment, check=False)

    assert python == "python"
    assert done.returncode == code
    assert asked == ["/readyz"]
