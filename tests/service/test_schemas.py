"""What compares messages with their schemas finds faults."""

import pytest
from schemas import SCHEMAS, answer_type, compare_with_schema

PONG = {"type": "pong", "workers": 2, "waiting": 0, "busy": 1.25, "time": 86400.5}


@pytest.mark.parametrize("message", [
    PONG | {"workers": -1}, PONG | {"extra": 1}, {"type": "pong"}, {"type": "none"},
    {"type": "at", "revision": 1, "highlight": {"element": "corner", "number": 1}},
    {"type": "at", "revision": 1, "highlight": {"element": "cell", "number": 1, "extra": 1}},
])
def test_a_faulty_message_is_found(message):
    with pytest.raises(AssertionError):
        compare_with_schema(message)


def test_good_messages_pass():
    for message in (PONG, PONG | {"id": 1}, {"type": "at", "revision": 1, "highlight": None}):
        compare_with_schema(message)


def test_requests_have_answers():
    assert answer_type("ping") == "pong" and answer_type("undo") == "done"
    assert answer_type("get", "frame") == "done" and answer_type("get", "critical") == "critical"
    whats = SCHEMAS["get.schema.json"]["properties"]["what"]["enum"]
    assert {f"{answer_type('get', what)}.schema.json" for what in whats} <= SCHEMAS.keys()
