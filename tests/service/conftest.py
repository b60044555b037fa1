"""Fixtures of the service tests; also runs test functions that are coroutines."""

import asyncio
import inspect

import pytest
from harness import DEADLINE, Server


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
        await asyncio.wait_for(pyfuncitem.obj(**arguments), 3 * DEADLINE)

    asyncio.run(run_with_deadline())
    return True
