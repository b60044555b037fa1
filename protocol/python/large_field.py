#!/usr/bin/env python3
"""Converts an array, which may be larger than memory, for the data folder of oval4d servers. The result is a Zarr
folder with coarser levels (OME-Zarr 0.4), or one .npy file, which servers map into memory. Needs python3-dask and
python3-zarr.

    large_field.py run.zarr large/run        # writes a Zarr folder
    large_field.py run.zarr large/run.npy    # writes a .npy file

The source is a Zarr array, path/to/folder::array in a Zarr folder, or a .npy file.
"""
import json
import sys
from pathlib import Path

import dask.array
import numpy
import zarr

CHUNK = (1, 128, 128, 128)  # samples of a chunk along t, z, y and x: 8 MiB; the server reads whole chunks
SMALLEST = 1 << 24          # samples; a level with at most this many gets no coarser level


def open_source_array(name):
    """Returns the source as a lazy array of 32-bit floats with the axes t, z, y and x. To read another format, such as
    HDF5, return dask.array.from_array(h5py_dataset) instead."""
    path, _, variable = name.partition("::")
    if path.endswith(".npy"):
        array = dask.array.from_array(numpy.load(path, mmap_mode="r"), chunks=CHUNK)
    else:
        array = dask.array.from_zarr(path, component=variable or None)
    assert array.ndim == 4, f"the array has {array.ndim} dimensions; t, z, y and x are needed"
    return array.astype("<f4")


def downsampled(array):
    """Returns the array at half the resolution: each value is the mean of 2 × 2 × 2 × 2 samples. An axis with one
    sample is not halved. If an axis has an odd number of samples, the last one is left out."""
    axes = {axis: 2 for axis, size in enumerate(array.shape) if size > 1}
    return dask.array.coarsen(numpy.mean, array, axes, trim_excess=True).astype("<f4")


def write_levels(array, folder):
    """Writes the array and its coarser levels to a Zarr folder. Each level is computed from the level before it, so
    that the source is read only once."""
    group = zarr.open_group(zarr.NestedDirectoryStore(folder), mode="w")  # the file of a chunk is t/z/y/x
    first, levels, steps = numpy.zeros(4), [], numpy.ones(4)
    while True:
        path = str(len(levels))
        chunk = tuple(map(min, CHUNK, array.shape))
        level = group.create_dataset(path, shape=array.shape, chunks=chunk, dtype="<f4")
        dask.array.store(array.rechunk(chunk), level, lock=False)
        levels.append({"path": path, "coordinateTransformations": [
            {"type": "scale", "scale": steps.tolist()}, {"type": "translation", "translation": first.tolist()}]})
        print(path, array.shape, flush=True)
        if array.size <= SMALLEST:
            break
        halved = numpy.array([2 if size > 1 else 1 for size in array.shape])
        first, steps = first + steps * (halved - 1) / 2, steps * halved  # the place of a mean is the middle of its samples
        array = downsampled(dask.array.from_array(level, chunks=chunk))
    group.attrs["multiscales"] = [{"version": "0.4", "axes": [
        {"name": "t", "type": "time"}, *({"name": name, "type": "space"} for name in "zyx")], "datasets": levels}]


def write_npy(array, file):
    out = numpy.lib.format.open_memmap(file, mode="w+", dtype="<f4", shape=array.shape)
    dask.array.store(array, out, lock=False)
    out.flush()
    print(json.dumps({"shape": array.shape, "bytes": Path(file).stat().st_size}))


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    source, target = sys.argv[1:]
    (write_npy if target.endswith(".npy") else write_levels)(open_source_array(source), target)


if __name__ == "__main__":
    main()
