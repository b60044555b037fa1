"""Makes the fixtures and the helper modules of tests/service and tests/attack available to the tests of this folder."""

import importlib.util
import sys
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(TESTS / "service"), str(TESTS / "attack")]

_spec = importlib.util.spec_from_file_location("service_conftest", TESTS / "service" / "conftest.py")
_service = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(_service)
shared_server, pytest_pyfunc_call = _service.shared_server, _service.pytest_pyfunc_call
