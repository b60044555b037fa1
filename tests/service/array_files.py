"""Writes arrays as files of each format that the server reads, and fills them with fields whose slices are known."""

import ctypes
import ctypes.util
import io
import struct
import tempfile
from pathlib import Path

import numpy


def quadratic(shape=(9, 10, 11, 12), ends=1.0):
    """Returns the samples of ends² − x² − y² − z² − w² on [−1, 1]⁴, with the axes tzyx, as 32-bit floats."""
    axes = [numpy.linspace(-1, 1, size) if size > 1 else numpy.zeros(1) for size in shape]
    grid = numpy.meshgrid(*axes, indexing="ij")
    return (ends**2 - sum(axis**2 for axis in grid)).astype("f4")


def npy(values):
    file = io.BytesIO()
    numpy.save(file, values)
    return file.getvalue()


def netcdf(values, name="v"):
    """Returns a classic NetCDF file with one variable of big-endian 32-bit floats, without coordinates."""
    def text(word):
        raw = word.encode()
        return struct.pack(">i", len(raw)) + raw + b"\0" * (-len(raw) % 4)

    rank = values.ndim
    head = b"CDF\1" + struct.pack(">iii", 0, 10, rank)
    for axis, size in zip("tzyx"[-rank:], values.shape):
        head += text("dim" + axis) + struct.pack(">i", size)
    head += struct.pack(">ii", 0, 0) + struct.pack(">ii", 11, 1) + text(name) + struct.pack(">i", rank)
    head += struct.pack(f">{rank}i", *range(rank)) + struct.pack(">ii", 0, 0) + struct.pack(">ii", 5, values.nbytes)
    return head + struct.pack(">i", len(head) + 4) + values.astype(">f4").tobytes()


def netcdf_with_units(values, quantity, unit, units):
    """Returns a classic NetCDF file with a variable v of 32-bit floats, whose indices are t, z, y and x, and
    coordinates from 0 to 1 along each. `quantity` and `unit` are the attributes long_name and units of v, as texts or
    bytes, and `units` maps the name of each axis to the unit of its coordinates."""
    def text(word):
        raw = word if isinstance(word, bytes) else word.encode()
        return struct.pack(">i", len(raw)) + raw + b"\0" * (-len(raw) % 4)

    def attributes(**texts):
        return struct.pack(">ii", 12, len(texts)) + b"".join(
            text(name) + struct.pack(">i", 2) + text(value) for name, value in texts.items())

    variables = [(axis, [index], attributes(units=units[axis]), 6, numpy.linspace(0, 1, size).astype(">f8").tobytes())
                 for index, (axis, size) in enumerate(zip("tzyx", values.shape))]
    variables.append(("v", range(4), attributes(long_name=quantity, units=unit), 5, values.astype(">f4").tobytes()))

    def header(begin):
        head = b"CDF\1" + struct.pack(">iii", 0, 10, 4)
        head += b"".join(text(axis) + struct.pack(">i", size) for axis, size in zip("tzyx", values.shape))
        head += struct.pack(">ii", 0, 0) + struct.pack(">ii", 11, len(variables))
        for name, dimensions, about, number, data in variables:
            head += text(name) + struct.pack(f">i{len(dimensions)}i", len(dimensions), *dimensions) + about
            head += struct.pack(">iii", number, len(data), begin)
            begin += len(data)
        return head

    return header(len(header(0))) + b"".join(data for *_, data in variables)


def hdf5(values, path="group/v"):
    """Returns an HDF5 file with one dataset, written by the library."""
    name = ctypes.util.find_library("hdf5_serial") or ctypes.util.find_library("hdf5")
    library = ctypes.CDLL(name)
    known = ctypes.c_int64

    def call(function, *arguments):
        member = getattr(library, function)
        member.restype = known
        result = member(*arguments)
        assert result >= 0, function
        return known(result)

    call("H5open")
    floats = known.in_dll(library, "H5T_NATIVE_FLOAT_g")
    default = known(0)
    values = numpy.ascontiguousarray(values, "f4")
    with tempfile.TemporaryDirectory() as folder:
        file_path = Path(folder) / "file.h5"
        file = call("H5Fcreate", str(file_path).encode(), ctypes.c_uint(2), default, default)
        groups = path.split("/")[:-1]
        for depth in range(len(groups)):
            group = call("H5Gcreate2", file, "/".join(groups[: depth + 1]).encode(), default, default, default)
            call("H5Gclose", group)
        sizes = (ctypes.c_uint64 * values.ndim)(*values.shape)
        space = call("H5Screate_simple", ctypes.c_int(values.ndim), sizes, None)
        data = call("H5Dcreate2", file, path.encode(), floats, space, default, default, default)
        call("H5Dwrite", data, floats, default, default, default, values.ctypes.data_as(ctypes.c_void_p))
        for close, handle in (("H5Dclose", data), ("H5Sclose", space), ("H5Fclose", file)):
            call(close, handle)
        return file_path.read_bytes()


def nifti(values):
    """Returns a NIfTI-1 file; its first index, x, varies fastest."""
    sizes = list(values.shape[::-1]) + [1] * (7 - values.ndim)
    header = bytearray(348)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, values.ndim, *sizes)
    struct.pack_into("<hh", header, 70, 16, 32)  # 32-bit floats
    struct.pack_into("<8f", header, 76, 1, 1, 1, 1, 1, 1, 1, 1)
    struct.pack_into("<f", header, 108, 352)
    header[344:348] = b"n+1\0"
    return bytes(header) + b"\0\0\0\0" + values.astype("<f4").tobytes()


WRITERS = {"npy": npy, "netcdf": netcdf, "hdf5": hdf5, "nifti": nifti}
