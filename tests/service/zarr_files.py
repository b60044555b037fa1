"""Writes arrays as Zarr folders, versions 2 and 3, chunk by chunk."""

import ctypes
import ctypes.util
import gzip
import itertools
import json
import struct
import zlib

import numpy


def library(name):
    return ctypes.CDLL(ctypes.util.find_library(name))


def zstd(data):
    compress = library("zstd").ZSTD_compress
    compress.restype = ctypes.c_size_t
    out = ctypes.create_string_buffer(len(data) + 1024)
    size = compress(out, ctypes.c_size_t(len(out)), data, ctypes.c_size_t(len(data)), ctypes.c_int(3))
    return out.raw[:size]


def blosc(data, compressor="lz4", shuffle=1, size=4):
    compress = library("blosc").blosc_compress_ctx
    out = ctypes.create_string_buffer(len(data) + 1024)
    length = compress(ctypes.c_int(5), ctypes.c_int(shuffle), ctypes.c_size_t(size), ctypes.c_size_t(len(data)), data, out,
                      ctypes.c_size_t(len(out)), compressor.encode(), ctypes.c_size_t(0), ctypes.c_int(1))
    assert length > 0
    return out.raw[:length]


def same(data):
    return data


COMPRESSORS = {"": same, "gzip": gzip.compress, "zlib": zlib.compress, "zstd": zstd, "blosc": blosc}
TYPES = {"b1": "bool", "i1": "int8", "u1": "uint8", "i2": "int16", "u2": "uint16", "i4": "int32", "u4": "uint32",
         "i8": "int64", "u8": "uint64", "f2": "float16", "f4": "float32", "f8": "float64"}


def write_json(path, content):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(content), encoding="utf-8")


def write(folder, values, chunk, version=2, compressor="", order="C", separator="", fill=0, skipped=(), names=None,
          attributes=None):
    """Writes an array. `skipped` are the indices of chunks that are left out."""
    attributes = dict(attributes or {})
    little = values.dtype.newbyteorder("<").str if values.dtype.byteorder in "=|" else values.dtype.str
    fortran = list(range(values.ndim))[::-1]
    if version == 2:
        separator = separator or "."
        write_json(folder / ".zarray", {
            "zarr_format": 2, "shape": values.shape, "chunks": chunk, "dtype": little, "order": order, "filters": None,
            "fill_value": fill, "dimension_separator": separator, "compressor": {"id": compressor} if compressor else None})
        if names:
            attributes["_ARRAY_DIMENSIONS"] = names
        if attributes:
            write_json(folder / ".zattrs", attributes)
    else:
        separator = separator or "/"
        codecs = [{"name": "transpose", "configuration": {"order": fortran}}] if order == "F" else []
        codecs.append({"name": "bytes", "configuration": {"endian": "big" if little[0] == ">" else "little"}})
        if compressor:
            codecs.append({"name": compressor, "configuration": {}})
        write_json(folder / "zarr.json", {
            "zarr_format": 3, "node_type": "array", "shape": values.shape, "data_type": TYPES[little[1:]],
            "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": chunk}},
            "chunk_key_encoding": {"name": "default", "configuration": {"separator": separator}}, "fill_value": fill,
            "codecs": codecs, "attributes": attributes} | ({"dimension_names": names} if names else {}))
    for index in itertools.product(*(range(-(-size // part)) for size, part in zip(values.shape, chunk))):
        if index in skipped:
            continue
        part = values[tuple(slice(i * c, (i + 1) * c) for i, c in zip(index, chunk))]
        whole = numpy.full(chunk, 77, values.dtype)  # readers must not see the 77 beyond the array's end
        whole[tuple(slice(0, n) for n in part.shape)] = part
        path = folder / (("c" + separator if version == 3 else "") + separator.join(map(str, index)))
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(COMPRESSORS[compressor](whole.tobytes(order)))


def crc32c(data):
    crc = 0xFFFFFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0x82F63B78 if crc & 1 else 0)
    return crc ^ 0xFFFFFFFF


def write_shards(folder, values, chunk, shard, compressor="", fill=0):
    """Writes an array of version 3 in shards of so many samples, which have chunks. Chunks of which all samples are 0 are
    left out, and shards of which all chunks are."""
    little = {"name": "bytes", "configuration": {"endian": "little"}}
    codecs = [little, *([{"name": compressor, "configuration": {}}] if compressor else [])]
    write_json(folder / "zarr.json", {
        "zarr_format": 3, "node_type": "array", "shape": values.shape, "data_type": TYPES[values.dtype.str[1:]], "fill_value": fill,
        "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": shard}}, "chunk_key_encoding": {"name": "default"},
        "codecs": [{"name": "sharding_indexed", "configuration": {
            "chunk_shape": chunk, "codecs": codecs, "index_codecs": [little, {"name": "crc32c"}]}}]})
    for index in itertools.product(*(range(-(-size // part)) for size, part in zip(values.shape, shard))):
        body, places = b"", b""
        for inner in itertools.product(*(range(size // part) for size, part in zip(shard, chunk))):
            first = [i * s + j * c for i, s, j, c in zip(index, shard, inner, chunk)]
            part = values[tuple(slice(f, f + c) for f, c in zip(first, chunk))]
            if not part.any():  # also for chunks beyond the array
                places += struct.pack("<QQ", 2**64 - 1, 2**64 - 1)
                continue
            whole = numpy.full(chunk, 77, values.dtype)
            whole[tuple(slice(0, n) for n in part.shape)] = part
            packed = COMPRESSORS[compressor](whole.tobytes())
            places += struct.pack("<QQ", len(body), len(packed))
            body += packed
        if body:
            path = folder / "c" / "/".join(map(str, index))
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(body + places + struct.pack("<I", crc32c(places)))
