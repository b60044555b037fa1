"""Fixtures of the service tests; also runs test functions that are coroutines."""

import asyncio
import collections
import inspect

import pytest
from harness import DEADLINE, Server, is_sanitizer_build

SANITIZED_CASES = 2
# After this many seconds, a coroutine test is ended with its traceback. Each wait in a test ends after DEADLINE, but a
# test may have many waits.
WHOLE_TEST_LIMIT = 20 * DEADLINE


def pytest_configure(config):
    config.addinivalue_line("markers", "release_only: computes for long; not run with sanitizers, with which the unit tests run this code")


def pytest_collection_modifyitems(config, items):
    """With sanitizers, everything takes several times as long: of a test with more than SANITIZED_CASES cases, only
    some are run, evenly spread. All cases of a test run the same code with different data; unit tests and fuzzers cover
    the readers of data."""
    if not is_sanitizer_build():
        return
    cases = collections.defaultdict(list)
    for item in items:
        if not item.get_closest_marker("release_only"):
            cases[item.nodeid.split("[")[0]].append(item)
    kept = {item for same in cases.values() for item in same[::-(-len(same) // SANITIZED_CASES)]}
    config.hook.pytest_deselected(items=[item for item in items if item not in kept])
    items[:] = [item for item in items if item in kept]


@pytest.fixture(scope="session", name="server")
def shared_server():
    """A server with default options, shared by all tests, which must leave it usable."""
    with Server() as server:
        yield server


def pytest_pyfunc_call(pyfuncitem):
    if not inspect.iscoroutinefunction(pyfuncitem.obj):
        return None
    arguments = {name: pyfuncitem.funcargs[name] for name in pyfuncitem._fixtureinfo.argnames}

    async def run_with_deadline():
        await asyncio.wait_for(pyfuncitem.obj(**arguments), WHOLE_TEST_LIMIT)

    asyncio.run(run_with_deadline())
    return True
