"""Reads exported files with other programs: admesh, assimp, and independent readers of 3MF, OpenSCAD and VTK files."""

import base64
import io
import json
import re
import struct
import subprocess
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import numpy

HERE = Path(__file__).resolve().parent
CORE = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"


def admesh_report(path):
    """Returns admesh's report on an STL file: numbers by name, and the bounding box."""
    done = subprocess.run(["admesh", str(path)], capture_output=True, text=True, timeout=120, check=True,
                          errors="replace")  # admesh 0.98.5 prints bytes beyond the end of the header
    number = {}
    for name, value in re.findall(r"^(.*?)\s+:\s+(-?[\d.]+)", done.stdout, re.MULTILINE):
        number[name.strip()] = float(value)
    number["volume"] = float(re.search(r"Volume\s+:\s+(-?[\d.]+)", done.stdout).group(1))
    number["box"] = [[float(v) for v in pair]
                     for pair in re.findall(r"Min .\s*=\s*(\S+), Max .\s*=\s*(\S+)", done.stdout)]
    return number


def assert_closed_mesh(path, parts=None):
    """Asserts that admesh finds nothing to repair; returns its report."""
    report = admesh_report(path)
    for fault in ("Total disconnected facets", "Degenerate facets", "Edges fixed", "Facets removed", "Facets added",
                  "Facets reversed", "Backwards edges", "Normals fixed"):
        assert report[fault] == 0, (fault, report)
    assert report["volume"] > 0
    if parts is not None:
        assert report["Number of parts"] == parts
    return report


def stl_triangles(data):
    """Returns the corners of each triangle of a binary STL file, as an array of shape (triangles, 3, 3)."""
    count = struct.unpack_from("<I", data, 80)[0]
    assert len(data) == 84 + 50 * count
    records = numpy.frombuffer(data, [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")], count, 84)
    return records["corners"].astype(float)


def convert_with_assimp(path, to):
    """Converts a file to STL with assimp, which joins equal points."""
    subprocess.run(["assimp", "export", str(path), str(to), "-fstlb", "-jiv"], capture_output=True, timeout=120, check=True)
    return to


def read_three_mf(data):
    """Returns (name, points, triangles) of each object of a 3MF file; asserts that all objects are printed, in mm."""
    archive = zipfile.ZipFile(io.BytesIO(data))
    assert archive.testzip() is None
    assert {"[Content_Types].xml", "_rels/.rels"} <= set(archive.namelist())
    relations = ElementTree.fromstring(archive.read("_rels/.rels"))
    model = ElementTree.fromstring(archive.read(relations[0].get("Target").lstrip("/")))
    assert model.get("unit") == "millimeter"
    objects = {}
    for object_ in model.iter(CORE + "object"):
        points = [tuple(float(v.get(a)) for a in "xyz") for v in object_.iter(CORE + "vertex")]
        triangles = [tuple(int(t.get(a)) for a in ("v1", "v2", "v3")) for t in object_.iter(CORE + "triangle")]
        objects[object_.get("id")] = (object_.get("name"), points, triangles)
    assert [item.get("objectid") for item in model.iter(CORE + "item")] == list(objects)
    return list(objects.values())


SCAD_MODULE = re.compile(r"\n// (.*)\nmodule (body_\d+)\(\) {\n"
                         r'    color\("#[0-9a-f]{6}"\) polyhedron\(convexity = 10, points = ([^=]*?), faces = ([^=]*?)\);\n'
                         r"}\n")
SCAD_CALL = re.compile(r"translate\(\[.*\]\) (body_\d+)\(\);\n")


def read_scad(data):
    """Returns (name, points, faces) of each module of an OpenSCAD program; asserts that the program calls each once
    and has nothing else."""
    text = data.decode()
    modules = SCAD_MODULE.findall(text)
    rest = SCAD_MODULE.sub("", text)
    assert re.fullmatch(r"// .*, in millimeters, from oval4d\n\n", SCAD_CALL.sub("", rest)), rest[:500]
    assert SCAD_CALL.findall(rest) == [module for _, module, _, _ in modules]
    return [(name, json.loads(points), json.loads(faces)) for name, _, points, faces in modules]


def assert_manifold(triangles):
    """Asserts that every edge is in two triangles, once in each direction."""
    starts = numpy.asarray(triangles, dtype=numpy.int64)
    ends = numpy.roll(starts, -1, axis=1)
    points = starts.max() + 1
    edges, reversed_edges = (numpy.sort((a * points + b).ravel()) for a, b in ((starts, ends), (ends, starts)))
    assert (edges[1:] != edges[:-1]).all()
    assert (edges == reversed_edges).all()


def volume(points, triangles):
    """Returns the volume that closed surfaces enclose: the sum of tetrahedra with a corner at the origin."""
    return volume_of(numpy.asarray(points, dtype=float)[numpy.asarray(triangles)])


def volume_of(corners):
    """Returns the volume that triangles enclose whose corners are an array of shape (triangles, 3, 3)."""
    return float(numpy.linalg.det(corners).sum() / 6)


def validate_glb(path):
    done = subprocess.run(["node", str(HERE / "validate_glb.mjs"), str(path)], capture_output=True, text=True,
                          timeout=120, check=True)
    return json.loads(done.stdout)


VTK_TYPES = {"Float32": "f", "Float64": "d", "Int32": "i", "Int64": "q", "UInt8": "B"}


def vtk_array(node):
    """Returns the numbers of a DataArray element, as tuples if it has several components."""
    assert node.tag == "DataArray" and node.get("format") == "binary", node.attrib
    data = base64.b64decode(node.text.strip(), validate=True)
    kind = VTK_TYPES[node.get("type")]
    (size,) = struct.unpack_from("<Q", data)
    assert size == len(data) - 8 and size % struct.calcsize(kind) == 0
    numbers = list(struct.unpack(f"<{size // struct.calcsize(kind)}{kind}", data[8:]))
    components = int(node.get("NumberOfComponents"))
    return [tuple(numbers[i:i + components]) for i in range(0, len(numbers), components)] if components > 1 else numbers


def read_vtk(data, type_):
    """Returns the arrays of a VTK XML file with one piece: by section, then by name. For an image, also returns its
    lattice."""
    root = ElementTree.fromstring(data)
    assert root.tag == "VTKFile" and root.get("type") == type_
    assert root.get("byte_order") == "LittleEndian" and root.get("header_type") == "UInt64"
    (whole,) = root
    (piece,) = whole
    assert whole.tag == type_ and piece.tag == "Piece"
    result = {section.tag: {array.get("Name"): vtk_array(array) for array in section} for section in piece}
    if type_ == "ImageData":
        assert piece.get("Extent") == whole.get("WholeExtent")
        result["extent"] = [int(number) for number in whole.get("WholeExtent").split()]
        for name in ("Origin", "Spacing"):
            result[name.lower()] = [float(number) for number in whole.get(name).split()]
    else:
        assert int(piece.get("NumberOfPoints")) == len(result["Points"]["points"])
        for name in ("Verts", "Lines", "Polys"):
            list_ = result.get(name, {"offsets": [], "connectivity": []})
            assert int(piece.get(f"NumberOf{name}")) == len(list_["offsets"])
            assert all(0 <= p < len(result["Points"]["points"]) for p in list_["connectivity"])
    return result
