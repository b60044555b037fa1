"""What the documents say of the program, it does: its options, their defaults, and the names of its metrics."""

import re
from pathlib import Path

import pytest
from harness import run_oval4d
from schemas import SCHEMAS

ROOT = Path(__file__).resolve().parents[2]
DOCUMENTS = ["README.md", "SECURITY.md", "docker/README.md", "docker/large-fields.md", "protocol/README.md"]
UNITS = {"KiB": 1 << 10, "MiB": 1 << 20, "GiB": 1 << 30}
# Options of other programs that the documents mention.
FOREIGN = {"--attr-timeout", "--build", "--build-arg", "--cap-drop", "--cpus", "--dir-cache-time", "--fix", "--read-only",
           "--rm", "--scale", "--tmpfs", "--vfs-cache-mode"}
# The options of the server that are not limits.
NO_LIMITS = {"--allow-host", "--allow-origin", "--data", "--field-cache-folder", "--file-workers", "--host",
             "--io-threads", "--log-level", "--open", "--port", "--sandbox", "--spool", "--stop-timeout", "--store",
             "--store-timeout", "--token", "--trusted-proxy", "--version", "--web-root", "--workers"}


def text_of(document):
    return (ROOT / document).read_text(encoding="utf-8")


def defaults():
    """Returns the options of the server, with their defaults as --help states them; None if there is none."""
    found = re.findall(r"^ +(--[a-z-]+)(?: .*?(?:=(\S+))?)?(?: \.\.\.)?(?: \(Env:\w+\))?(?:  .*)?$",
                       run_oval4d("--help").stdout.decode(), re.MULTILINE)
    return {name: default or None for name, default in found}


def limit_rows():
    """Yields the rows of the table of limits: the options, their names in `welcome`, and the default."""
    table = text_of("protocol/README.md").split("\n## Limits\n")[1].split("\n## ")[0]
    for options, names, default in re.findall(r"^\| (`--[^|]*)\|([^|]*)\| ([^|]*) \|", table, re.MULTILINE):
        yield re.findall(r"`(--[a-z-]+)`", options), re.findall(r"`(\w+)`", names), default


def number_in(text):
    """Returns the number at the start of a text such as "8 MiB for a load" or "10,000", or None."""
    found = re.match(r"([\d,]+)(?: (KiB|MiB|GiB)\b)?", text)
    return found and int(found[1].replace(",", "")) * UNITS.get(found[2], 1)


def test_help_states_the_defaults():
    assert defaults()["--port"] == "8080" and defaults()["--open"] is None and defaults()["--max-depth"] == "32"


def test_each_limit_is_in_the_table_with_its_default():
    known, documented = defaults(), {}
    for options, _, default in limit_rows():
        documented |= {option: number_in(default) for option in options}
    assert set(documented) == set(known) - NO_LIMITS
    assert documented == {option: float(known[option]) or None for option in documented}


def test_the_table_names_the_limits_in_welcome():
    described = SCHEMAS["welcome.schema.json"]["properties"]["limits"]["properties"]
    assert [name for _, names, _ in limit_rows() for name in names] == list(described)


@pytest.mark.parametrize("document", DOCUMENTS)
def test_options_that_a_document_names_exist(document):
    settings = SCHEMAS["settings.schema.json"]["properties"]
    members = {name for each in settings.values() for name in each.get("properties", {})}
    of_state = {f"--{name}" for name in {*settings, *members, "load", "box", "rotate", "formula"}}
    helps = "".join(run_oval4d(*command, "--help").stdout.decode() for command in ([], ["render"], ["export"]))
    named = set(re.findall(r"(?<![\w-])--[a-z][a-z_-]*\w(?!-)\b", text_of(document)))
    assert named - FOREIGN - of_state <= set(re.findall(r"--[a-z][a-z_-]*\w", helps))


@pytest.mark.parametrize("document", DOCUMENTS)
def test_defaults_in_parentheses_are_those_of_the_program(document):
    """Such as `--max-upload` (256 MiB)."""
    stated = re.findall(r"`(--[a-z-]+)` \(([\d,]+(?: \w+)?)\)", text_of(document)) + \
        [(option, default) for default, option in re.findall(r"\(([\d,]+(?: \w+)?), `(--[a-z-]+)`\)", text_of(document))]
    known = defaults()
    assert {option: number_in(default) for option, default in stated} == {option: float(known[option]) for option, _ in stated}


def test_metrics_that_the_documents_name_exist():
    named = {name for document in DOCUMENTS for name in re.findall(r"`(oval4d_[a-z_]+)[`{]", text_of(document))}
    assert "oval4d_store_up" in named
    known = set(re.findall(r'"(oval4d_\w+)"', text_of("server/net/metrics.cpp")))
    assert named - {"oval4d_client", "oval4d_messages"} <= known
