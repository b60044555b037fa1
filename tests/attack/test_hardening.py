"""The binary is built with hardening, which makes faults harder to exploit."""

import platform
import re
import subprocess

import pytest
from harness import PROGRAM, sanitized

pytestmark = pytest.mark.skipif(sanitized(), reason="sanitizers are built without")


def told_by(tool, *words):
    return subprocess.run([tool, *words], capture_output=True, text=True, check=True).stdout


def readelf(*options, file=PROGRAM):
    return told_by("readelf", "--wide", *options, str(file))


def symbols(file, defined):
    """Returns the names of defined or undefined dynamic symbols, without versions."""
    names = set()
    for line in readelf("--dyn-syms", file=file).splitlines():
        fields = line.split()
        if len(fields) >= 8 and fields[0].rstrip(":").isdigit() and (fields[6] != "UND") == defined:
            names.add(fields[7].partition("@")[0])
    return names


def test_it_lies_at_any_address():
    assert re.search(r"Type:\s+DYN", readelf("--file-header"))
    assert re.search(r"FLAGS_1.*\bPIE\b", readelf("--dynamic"))


def test_addresses_of_functions_are_read_only():
    dynamic, segments = readelf("--dynamic"), readelf("--segments")
    assert re.search(r"\(FLAGS\).*\bBIND_NOW\b", dynamic) and re.search(r"FLAGS_1.*\bNOW\b", dynamic)
    relro = re.search(r"GNU_RELRO\s+0x\S+\s+(0x\S+)\s+0x\S+\s+0x\S+\s+(0x\S+)", segments)
    begin, size = (int(x, 16) for x in relro.groups())
    tables = re.findall(r"\] (\.got\S*|\.init_array|\.dynamic)\s+\S+\s+([0-9a-f]+)\s+[0-9a-f]+\s+([0-9a-f]+)",
                        readelf("--sections"))
    assert len(tables) >= 3
    for name, at, length in tables:
        assert begin <= int(at, 16) and int(at, 16) + int(length, 16) <= begin + size, name


def test_nothing_is_written_and_run():
    """No segment is both writable and executable, not even the stack."""
    flags = re.findall(r"^\s+(LOAD|GNU_STACK)\s+(?:0x\S+\s+){5}([RWE ]+?)\s+0x", readelf("--segments"), re.M)
    assert ("GNU_STACK", "RW") in flags and len(flags) > 3
    assert not [entry for entry in flags if "W" in entry[1] and "E" in entry[1]]
    assert "TEXTREL" not in readelf("--dynamic")


@pytest.mark.skipif(platform.machine() not in ("x86_64", "aarch64"), reason="not of this processor")
def test_indirect_jumps_end_where_they_may():
    mark, places = (("IBT, SHSTK", "endbr64") if platform.machine() == "x86_64" else ("", "bti|paciasp"))
    assert mark in readelf("--notes")
    code = told_by("objdump", "--disassemble=main", "--no-show-raw-insn", str(PROGRAM))
    first = next(line for line in code.splitlines() if re.match(r"\s+[0-9a-f]+:\s", line))
    assert re.search(places, first), first


def test_stacks_are_guarded_and_copies_checked():
    called = symbols(PROGRAM, defined=False)
    assert "__stack_chk_fail" in called
    assert {"__memcpy_chk", "__snprintf_chk"} & called
    # Unchecked functions, which the compiler leaves where it does not know the size of the buffer: there are none.
    assert not {"gets", "strcpy", "strcat", "sprintf", "vsprintf"} & called


def test_no_library_is_loaded_that_nothing_is_used_of():
    needed = re.findall(r"\(NEEDED\).*\[(.+)\]", readelf("--dynamic"))
    places = dict(re.findall(r"(\S+) => (\S+)", told_by("ldd", str(PROGRAM))))
    called = symbols(PROGRAM, defined=False)
    assert len(needed) > 5
    for library in needed:
        assert symbols(places[library], defined=True) & called, library
