"""Requests exported files over HTTP; the table of their formats."""

import csv
import io
import json
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
TABLE = json.loads((ROOT / "protocol/export_formats.json").read_text(encoding="utf-8"))["formats"]
ROTATION = "rotate=xw,yz:0.39,1.42"
SVG = "{http://www.w3.org/2000/svg}"


def fetch_file(server, format_, query, status=200):
    answer = server.get(f"/api/v1/file.{format_}?{query}")
    assert answer.status == status, answer.body[:500]
    return answer.body


def fetch_file_to(server, path, query):
    path.write_bytes(fetch_file(server, path.suffix[1:], query))
    return path


def export_refusal(server, format_, query, status=400):
    return json.loads(fetch_file(server, format_, query, status))


def csv_rows(server, query):
    """Returns the rows of a CSV file, as mappings from the names of the columns."""
    return list(csv.DictReader(io.StringIO(fetch_file(server, "csv", query).decode())))
