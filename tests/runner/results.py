"""The results of tests: one for each test case of a JUnit file, or one for a whole check that writes no such file."""

import xml.etree.ElementTree
from dataclasses import dataclass


@dataclass(frozen=True)
class Result:
    """The outcome of one test case. `case` identifies it within its check: (class name, name) of the JUnit file, or
    None if the result stands for the whole check."""

    name: str
    outcome: str  # "passed", "failed" or "skipped"
    message: str = ""
    case: tuple[str, str] | None = None


def failure_text(element):
    """Returns the text of a <failure> or <error>: the attribute `message`, or the content if it has none."""
    return (element.get("message") or element.text or "no message").strip()


def read_junit(path, prefix):
    """Returns the results in a JUnit file, or None if the file is absent or incomplete. Their names begin with
    `prefix`. If a file lists a test case several times, a failure counts before a success."""
    try:
        cases = list(xml.etree.ElementTree.parse(path).iter("testcase"))
    except (OSError, xml.etree.ElementTree.ParseError):
        return None
    found = {}
    for case in cases:
        key = (case.get("classname") or "", case.get("name") or "")
        name = prefix + ".".join(filter(None, key))
        failures = [child for child in case if child.tag in ("failure", "error")]
        skipped = case.find("skipped") is not None or case.get("result") in ("skipped", "suppressed")
        if failures:
            found[key] = Result(name, "failed", "\n".join(map(failure_text, failures)), key)
        elif key not in found:
            found[key] = Result(name, "skipped" if skipped else "passed", "", key)
    return list(found.values())
