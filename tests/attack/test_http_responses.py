"""HTTP responses: what they say of their content, conditional requests, and ranges."""

import re

import pytest
from http_site import SCRIPT
from raw import Socket, fetch, request


def test_responses_state_type_and_forbid_cross_origin_reads(site_server):
    for path in ("/", "/app.js", "/healthz", "/metrics", "/api/v1/keymap", "/nothing", "/api/v1/frame.png?width=64&height=64",
                 "/api/v1/frame.png?width=x", "/api/v1/file.off"):
        answer = fetch(site_server, path)
        assert answer.get("X-Content-Type-Options") == "nosniff" and answer.get("Content-Type")
        assert answer.get("Access-Control-Allow-Origin") in (None,), "pages of other origins may read it"


# --- Conditional requests (RFC 9110, section 13)

def etag_of(site_server, path="/app.js", *fields):
    return fetch(site_server, path, *fields).get("ETag")


def test_a_matching_etag_gets_304(site_server):
    tag = etag_of(site_server)
    for text in (tag, "*", f"W/{tag}", f'"x", {tag}', f'{tag}, "x"', f'"x",{tag},"y"', f'W/"x", W/{tag}', f'"a,b", {tag}', f' {tag} '):
        answer = fetch(site_server, "/app.js", f"If-None-Match: {text}")
        assert answer.status == 304 and answer.get("ETag") == tag, text
        assert fetch(site_server, "/app.js", f"If-None-Match: {text}", method="HEAD").status == 304
    with Socket(site_server) as raw:
        raw.send(request("/app.js", 'If-None-Match: "x"', f"If-None-Match: {tag}") + request("/healthz", close=True))
        assert [answer.status for answer in raw.read_responses()] == [304, 200], "repeated fields must form one list"


def test_other_etags_get_the_file(site_server):
    tag = etag_of(site_server)
    bare = tag.strip('"')
    for text in ('"x"', bare, f'"{bare}x"', f'"x{bare}"', f'"x{tag}', f'"{bare.upper()}X"', '"*"', "W/*", "", f'"a{tag}b"', f'"{bare[:-1]}"'):
        answer = fetch(site_server, "/app.js", f"If-None-Match: {text}")
        assert answer.status == 200 and answer.body == SCRIPT, text
    assert fetch(site_server, "/nothing", "If-None-Match: *").status == 404
    tag = etag_of(site_server, "/packed.js")
    assert fetch(site_server, "/packed.js", f"If-None-Match: {tag}", "Accept-Encoding: gzip").status == 200


# --- Range requests (RFC 9110, section 14): a server may ignore a range, but must not send wrong bytes

def parse_ranges(text, size):
    """Parses a Range field: returns (first, last) of each satisfiable range, None if the field is invalid."""
    match = re.fullmatch(r"bytes=(.*)", text)
    if not match:
        return None
    found = []
    for part in match[1].split(","):
        numbers = re.fullmatch(r"[ \t]*(\d*)-(\d*)[ \t]*", part)
        if not numbers or numbers[0].strip() == "-":
            return None
        first, last = numbers.groups()
        if first and last and int(first) > int(last):
            return None
        if not first:
            count = min(int(last), size)
            found += [(size - count, size - 1)] if count else []
        elif int(first) < size:
            found.append((int(first), min(int(last or size), size - 1)))
    return found


def multipart_ranges(answer):
    """Returns (first, last, content) of each part of a multipart/byteranges response."""
    boundary = re.search(r'boundary="?([^";]+)', answer.get("Content-Type"))[1].encode()
    found = []
    for part in answer.body.split(b"--" + boundary)[1:-1]:
        head, _, content = part.removeprefix(b"\r\n").partition(b"\r\n\r\n")
        first, last = re.search(rb"(?i)content-range: bytes (\d+)-(\d+)/", head).groups()
        found.append((int(first), int(last), content.removesuffix(b"\r\n")))
    return found


def assert_range_response(answer, text, full):
    asked, size = parse_ranges(text, len(full)), len(full)
    if answer.status == 200:
        assert answer.body == full
        assert answer.get("Accept-Ranges") in (None, "none", "bytes")
        return
    if answer.status == 416:
        assert not asked and answer.get("Content-Range") == f"bytes */{size}"
        return
    assert answer.status == (400 if asked is None else 206), answer
    if answer.status == 206:
        assert asked
        if answer.get("Content-Type").startswith("multipart/byteranges"):
            assert len(asked) > 1 and answer.get("Content-Range") is None
            parts = multipart_ranges(answer)
        else:
            first, last, whole = re.fullmatch(r"bytes (\d+)-(\d+)/(\d+)", answer.get("Content-Range")).groups()
            assert int(whole) == size
            parts = [(int(first), int(last), answer.body)]
        for first, last, content in parts:
            assert content == full[first:last + 1]
        covered = {at for first, last, _ in parts for at in range(first, last + 1)}
        assert covered >= {at for first, last in asked for at in range(first, last + 1)}


RANGES = ["bytes=0-0", "bytes=0-99", "bytes=100-", "bytes=-1", "bytes=-100", "bytes=0-", "bytes=0-99999999", "bytes=-99999999",
          "bytes=1899-1899", "bytes=1900-", "bytes=1900-1900", "bytes=99999-", "bytes=-0", "bytes=0-0,-1", "bytes=0-9, 20-29,50-",
          "bytes=0-9,5-14", "bytes=9-5", "bytes=", "bytes=-", "bytes=a-b", "bytes 0-9", "bytes=0-9,", "bytes=,0-9", "bytes=0--1",
          "bytes=0-9-10", "bytes=0x0-0x9", "bytes=+0-9", "octets=0-9", "items=0-9", "=0-9", "0-9", "", "bytes=0-18446744073709551615",
          "bytes=18446744073709551616-", "bytes=-18446744073709551616", "bytes=" + ",".join(["0-"] * 1000), "bytes=0-9;10-19",
          "bytes=0-0" + ",0-0" * 1000, "BYTES=0-9"]


@pytest.mark.parametrize("text", RANGES, ids=lambda text: text[:30])
@pytest.mark.parametrize("path", ["/app.js", "/api/v1/keymap", "/api/v1/file.csv", "/empty.txt"])
def test_ranges_are_served_correctly_or_ignored(site_server, text, path):
    full = fetch(site_server, path)
    assert full.status == 200
    answer = fetch(site_server, path, f"Range: {text}")
    assert_range_response(answer, text, full.body)
    assert len(answer.body) <= 2 * len(full.body) + 1000, "the ranges make the response larger than the file"
    assert fetch(site_server, path, f"Range: {text}", method="HEAD").status in (200, 206, 416)


def test_if_range_serves_a_range_only_of_the_current_file(site_server):
    """If-Range (RFC 9110, 13.1.5): a range is served only if the client's tag is current."""
    tag = etag_of(site_server)
    for text in ('"x"', f"W/{tag}", "Sat, 29 Oct 1994 19:43:31 GMT", tag.strip('"'), "*"):
        answer = fetch(site_server, "/app.js", "Range: bytes=0-9", f"If-Range: {text}")
        assert answer.status == 200 and answer.body == SCRIPT, text
    assert_range_response(fetch(site_server, "/app.js", "Range: bytes=0-9", f"If-Range: {tag}"), "bytes=0-9", SCRIPT)
    assert fetch(site_server, "/app.js", "Range: bytes=0-9", f"If-None-Match: {tag}").status == 304
    assert fetch(site_server, "/nothing", "Range: bytes=0-9").status == 404
