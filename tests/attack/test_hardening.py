"""The binary is built with hardening, which makes faults harder to exploit."""

import platform
import re
import subprocess

import pytest
from harness import PROGRAM, is_sanitizer_build

pytestmark = pytest.mark.skipif(is_sanitizer_build(), reason="sanitizer builds are not hardened")


def output_of(tool, *arguments):
    return subprocess.run([tool, *arguments], capture_output=True, text=True, check=True).stdout


def readelf(*options, file=PROGRAM):
    return output_of("readelf", "--wide", *options, str(file))


def dynamic_symbols(file, defined):
    """Returns the names of defined or undefined dynamic symbols, without versions."""
    names = set()
    for line in readelf("--dyn-syms", file=file).splitlines():
        fields = line.split()
        if len(fields) >= 8 and fields[0].rstrip(":").isdigit() and (fields[6] != "UND") == defined:
            names.add(fields[7].partition("@")[0])
    return names


def test_the_executable_is_position_independent():
    assert re.search(r"Type:\s+DYN", readelf("--file-header"))
    assert re.search(r"FLAGS_1.*\bPIE\b", readelf("--dynamic"))


def test_relocation_tables_are_read_only():
    dynamic, segments = readelf("--dynamic"), readelf("--segments")
    assert re.search(r"\(FLAGS\).*\bBIND_NOW\b", dynamic) and re.search(r"FLAGS_1.*\bNOW\b", dynamic)
    relro = re.search(r"GNU_RELRO\s+0x\S+\s+(0x\S+)\s+0x\S+\s+0x\S+\s+(0x\S+)", segments)
    begin, size = (int(x, 16) for x in relro.groups())
    tables = re.findall(r"\] (\.got\S*|\.init_array|\.dynamic)\s+\S+\s+([0-9a-f]+)\s+[0-9a-f]+\s+([0-9a-f]+)",
                        readelf("--sections"))
    assert len(tables) >= 3
    for name, at, length in tables:
        assert begin <= int(at, 16) and int(at, 16) + int(length, 16) <= begin + size, name


def test_no_segment_is_writable_and_executable():
    """No segment is both writable and executable, not even the stack."""
    flags = re.findall(r"^\s+(LOAD|GNU_STACK)\s+(?:0x\S+\s+){5}([RWE ]+?)\s+0x", readelf("--segments"), re.M)
    assert ("GNU_STACK", "RW") in flags and len(flags) > 3
    assert not [entry for entry in flags if "W" in entry[1] and "E" in entry[1]]
    assert "TEXTREL" not in readelf("--dynamic")


@pytest.mark.skipif(platform.machine() not in ("x86_64", "aarch64"), reason="only x86-64 and AArch64 have branch tracking")
def test_indirect_branch_tracking_is_enabled():
    property_, landing_pads = (("IBT, SHSTK", "endbr64") if platform.machine() == "x86_64" else ("", "bti|paciasp"))
    assert property_ in readelf("--notes")
    code = output_of("objdump", "--disassemble=main", "--no-show-raw-insn", str(PROGRAM))
    first = next(line for line in code.splitlines() if re.match(r"\s+[0-9a-f]+:\s", line))
    assert re.search(landing_pads, first), first


def test_stack_protector_and_checked_copies_are_used():
    called = dynamic_symbols(PROGRAM, defined=False)
    assert "__stack_chk_fail" in called
    assert {"__memcpy_chk", "__snprintf_chk"} & called
    # The compiler keeps calls of the unchecked functions below if it does not know the size of a buffer.
    assert not {"gets", "strcpy", "strcat", "sprintf", "vsprintf"} & called


def test_every_linked_library_is_used():
    needed = re.findall(r"\(NEEDED\).*\[(.+)\]", readelf("--dynamic"))
    paths = dict(re.findall(r"(\S+) => (\S+)", output_of("ldd", str(PROGRAM))))
    called = dynamic_symbols(PROGRAM, defined=False)
    assert len(needed) > 5
    for library in needed:
        assert dynamic_symbols(paths[library], defined=True) & called, library
