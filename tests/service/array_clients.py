"""Sends arrays to sessions, in messages and in uploads."""

import asyncio
import base64
import contextlib
import http.client
import json
from urllib.parse import quote, urlencode

from harness import DEADLINE

SIZE = {"width": 480, "height": 270}


def upload(server, session, token, name, body, method="PUT", moments=False, server_token=None, quote_via=quote,
           **query):
    """Uploads a file; returns the http.client response, with the decoded message as `.message`. `quote_via` encodes the
    values of the query."""
    connection = http.client.HTTPConnection(server.host, server.port, timeout=DEADLINE)
    path = f"/api/v1/sessions/{session}/fields/{quote(name, safe='')}" + ("/moments" if moments else "")
    query = urlencode(query | ({"token": server_token} if server_token else {}), quote_via=quote_via)
    with contextlib.closing(connection):
        connection.request(method, path + ("?" + query if query else ""), body,
                           {} if token is None else {"Session-Token": token})
        answer = connection.getresponse()
        answer.body = answer.read()
        is_json = answer.getheader("Content-Type") == "application/json"
        answer.message = json.loads(answer.body) if is_json else None
        return answer


async def put(client, name, body, **options):
    welcome = client.welcome
    return await asyncio.to_thread(upload, client.server, welcome["session"], welcome["token"], name, body, **options)


async def load(client, name, body, format_="npy", **members):
    return await client.request("load", name=name, format=format_, data=base64.b64encode(body).decode(), **members)


async def state_of(client):
    return await client.request("get", what="state")


def unnumbered(message):
    return {name: value for name, value in message.items() if name != "id"}
