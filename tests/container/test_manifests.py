"""docker/kubernetes and docker/compose.yaml are valid, consistent with each other and with the server."""

import json
import re
import subprocess
from pathlib import Path

import yaml

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "docker/kubernetes"


def kubernetes_objects():
    files = yaml.safe_load((FOLDER / "kustomization.yaml").read_text(encoding="utf-8"))["resources"]
    assert sorted(files) == sorted(path.name for path in FOLDER.glob("*.yaml") if path.name != "kustomization.yaml")
    return [item for file in files for item in yaml.safe_load_all((FOLDER / file).read_text(encoding="utf-8"))]


def find_object(kind, name="oval4d"):
    return next(item for item in kubernetes_objects() if (item["kind"], item["metadata"]["name"]) == (kind, name))


def schema_errors(checked_objects):
    done = subprocess.run(["node", ROOT / "tests/container/validate_manifests.mjs"], input=json.dumps(checked_objects), text=True,
                          capture_output=True, check=False)
    assert not done.stderr, done.stderr
    return done.stdout


def test_objects_match_the_schema_of_the_kubernetes_api():
    assert schema_errors(kubernetes_objects()) == ""
    wrong = find_object("Deployment")
    wrong["spec"]["replicas"] = "three"
    assert "replicas" in schema_errors([wrong])


def test_references_between_manifests_resolve():
    pod = find_object("Deployment")["spec"]["template"]
    labels = pod["metadata"]["labels"]
    (container,) = pod["spec"]["containers"]
    ports = {port["name"] for port in container["ports"]}
    for name in ("oval4d", "oval4d-sessions"):
        service = find_object("Service", name)["spec"]
        assert service["selector"].items() <= labels.items() and service["ports"][0]["targetPort"] in ports
    for path in find_object("Ingress")["spec"]["rules"][0]["http"]["paths"]:
        target = path["backend"]["service"]
        assert target["port"]["name"] in [port["name"] for port in find_object("Service", target["name"])["spec"]["ports"]]
    assert find_object("PodDisruptionBudget")["spec"]["selector"]["matchLabels"].items() <= labels.items()
    scaled = find_object("HorizontalPodAutoscaler")["spec"]["scaleTargetRef"]
    assert find_object(scaled["kind"], scaled["name"])
    store = next(variable["value"] for variable in container["env"] if variable["name"] == "OVAL4D_STORE")
    assert find_object("Service", store.removeprefix("redis://"))


def test_folders_for_temporary_files_are_writable():
    """The server spools unread files in /tmp, and fields that it converts in /var/tmp."""
    pod = find_object("Deployment")["spec"]["template"]["spec"]
    (container,) = pod["containers"]
    service = yaml.safe_load((ROOT / "docker/compose.yaml").read_text(encoding="utf-8"))["services"]["oval4d"]
    folders = {"/tmp", "/var/tmp"}
    assert container["securityContext"]["readOnlyRootFilesystem"] and service["read_only"]
    assert {mount["mountPath"] for mount in container["volumeMounts"]} == set(service["tmpfs"]) == folders
    assert {mount["name"] for mount in container["volumeMounts"]} == {volume["name"] for volume in pod["volumes"]}
    documented = (ROOT / "docker/README.md").read_text(encoding="utf-8")
    assert set(re.findall(r"--tmpfs (\S+?)[` ]", documented)) == folders


def bytes_of(size):
    """Returns a number, or a size such as 256M, 6Gi or 6g, in bytes."""
    number, unit = re.fullmatch(r"(\d+)([KMG]?)i?", size.upper().replace("I", "i")).groups()
    return int(number) << 10 * " KMG".index(unit or " ")


def test_memory_limits_cover_what_the_servers_may_use():
    """The sum is explained in server.yaml."""
    (container,) = find_object("Deployment")["spec"]["template"]["spec"]["containers"]
    limits = container["resources"]["limits"]
    in_pod = {variable["name"]: variable["value"] for variable in container["env"]} | {"OVAL4D_WORKERS": limits["cpu"]}
    service = yaml.safe_load((ROOT / "docker/compose.yaml").read_text(encoding="utf-8"))["services"]["oval4d"]
    for limit, variables in ((limits["memory"], in_pod), (service["mem_limit"], service["environment"])):
        workers, load_workers, load_memory, held, quota, edges, pixels, connections = (
            bytes_of(variables[f"OVAL4D_{name}"])
            for name in ("WORKERS", "LOAD_WORKERS", "LOAD_MEMORY", "MAX_BYTES", "STORE_QUOTA", "MAX_SLICE_EDGES", "MAX_PIXELS",
                         "MAX_CONNECTIONS"))
        drawing = workers + 1
        needed = (230 << 20) + held + quota + load_workers * load_memory + 512 * edges * (workers + 1 + drawing) \
            + 64 * pixels * drawing + (64 << 10) * connections
        assert 0.9 * bytes_of(limit) < needed < bytes_of(limit)
    help_text = (ROOT / "server/net/server_options.cpp").read_text(encoding="utf-8")
    for name in {*in_pod, *service["environment"]}:
        assert f'"--{name.removeprefix("OVAL4D_").lower().replace("_", "-")}"' in help_text


def test_the_metrics_for_scaling_exist_in_the_server():
    """The Prometheus adapter computes the autoscaler's metric from these metrics."""
    source = (ROOT / "server/net/metrics.cpp").read_text(encoding="utf-8")
    names = re.findall(r"oval4d_worker\w*", (FOLDER / "scaling.yaml").read_text(encoding="utf-8"))
    assert {"oval4d_worker_seconds_total", "oval4d_workers"} <= set(names) - {"oval4d_workers_busy"}
    for name in set(names) - {"oval4d_workers_busy"}:
        assert f'"{name}"' in source


def test_health_checks_send_what_the_server_answers():
    """HAProxy's health checks send OPTIONS unless they name another method; the server answers only GET and HEAD."""
    services = [find_object("Service", name) for name in ("oval4d", "oval4d-sessions")]
    checks = [service["metadata"]["annotations"]["haproxy.org/check-http"] for service in services]
    checks += re.findall("option httpchk (.*)", (ROOT / "docker/haproxy.cfg").read_text(encoding="utf-8"))
    assert checks == 3 * ["GET /readyz"]


def test_sessions_have_the_same_rules_as_in_the_composition():
    proxy = (ROOT / "docker/haproxy.cfg").read_text(encoding="utf-8")
    rules = re.findall("^ +(.+)", re.search("backend sessions\n(.*?)\n\n", proxy, re.DOTALL)[1], re.MULTILINE)
    annotations = find_object("Service", "oval4d-sessions")["metadata"]["annotations"]
    own_rules = [*annotations["haproxy.org/backend-config-snippet"].splitlines(),
                 "balance " + annotations["haproxy.org/load-balance"]]
    assert {rule for rule in rules if not rule.startswith("server-template")} <= set(own_rules)
    (paths,) = re.findall("use_backend sessions if { path_beg (.*) }", proxy)
    routed = find_object("Ingress")["spec"]["rules"][0]["http"]["paths"]
    assert paths.split() == [path["path"] for path in routed if path["backend"]["service"]["name"] == "oval4d-sessions"]


def test_forged_addresses_of_clients_are_removed():
    for name in ("oval4d", "oval4d-sessions"):
        rules = find_object("Service", name)["metadata"]["annotations"]["haproxy.org/backend-config-snippet"].splitlines()
        assert "http-request del-header X-Forwarded-For" in rules
    assert "http-request set-header X-Forwarded-For %[src]" in (ROOT / "docker/haproxy.cfg").read_text(encoding="utf-8")


def test_kustomize_accepts_the_manifests():
    done = subprocess.run(["kubectl", "kustomize", FOLDER], capture_output=True, text=True, check=True)
    assert len(list(yaml.safe_load_all(done.stdout))) == len(kubernetes_objects())
    assert "image: registry.example.org/oval4d:" in done.stdout


def test_docker_compose_accepts_the_compose_file():
    done = subprocess.run(["docker-compose", "--file", ROOT / "docker/compose.yaml", "config"], capture_output=True, text=True,
                          check=False)
    assert done.returncode == 0, done.stderr
    assert yaml.safe_load(done.stdout)["services"].keys() == {"proxy", "oval4d", "redis"}


def test_references_in_the_compose_file_resolve():
    compose = yaml.safe_load((ROOT / "docker/compose.yaml").read_text(encoding="utf-8"))
    services = compose["services"]
    assert (ROOT / "docker" / services["oval4d"]["build"]["context"] / services["oval4d"]["build"]["dockerfile"]).is_file()
    assert services["oval4d"]["environment"]["OVAL4D_STORE"].removeprefix("redis://") in services
    assert "server-template oval4d 10 oval4d:8080" in (ROOT / "docker/haproxy.cfg").read_text(encoding="utf-8")
