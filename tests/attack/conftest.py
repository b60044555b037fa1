"""Fixtures of the attack tests; also makes the fixtures and the helper modules of tests/service available to them."""

import gzip
import importlib.util
import sys
from pathlib import Path

import pytest

SERVICE = Path(__file__).resolve().parents[1] / "service"
sys.path.insert(0, str(SERVICE))
from harness import Server  # noqa: E402
from http_site import PAGE, SCRIPT  # noqa: E402
from raw import SharedSession, WebSocket  # noqa: E402

_spec = importlib.util.spec_from_file_location("service_conftest", SERVICE / "conftest.py")
_service = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(_service)
shared_server, pytest_pyfunc_call = _service.shared_server, _service.pytest_pyfunc_call


@pytest.fixture(name="site_server", scope="module")
def start_site_server(tmp_path_factory):
    root = tmp_path_factory.mktemp("site")
    (root / "index.html").write_bytes(PAGE)
    (root / "app.js").write_bytes(SCRIPT)
    (root / "packed.js").write_bytes(SCRIPT * 10)
    (root / "packed.js.gz").write_bytes(gzip.compress(SCRIPT * 10, mtime=0))
    (root / "empty.txt").write_bytes(b"")
    (root.parent / "secret.txt").write_text("secret")
    with Server("--web-root", root) as server:
        yield server


@pytest.fixture(name="session", scope="module")
def create_session(server):
    return SharedSession(server)


@pytest.fixture(name="peer")
def join_session(session):
    """A WebSocket that has joined the session."""
    with session.join() as joined:
        yield joined


@pytest.fixture(name="peer_without_hello")
def open_websocket(server):
    """A WebSocket before its hello."""
    with WebSocket(server) as opened:
        yield opened


@pytest.fixture(name="store_path")
def temporary_store_path(tmp_path):
    return tmp_path / "store" / "sessions.sqlite"
