#!/usr/bin/env python3
"""Writes the speed of an exact unsteady solution of the Navier–Stokes equations to a NetCDF file. Then shows the speed
as a field, whose axis w is time, and saves a picture.

C. R. Ethier and D. A. Steinman, "Exact fully 3D Navier–Stokes solutions for benchmarking", International Journal for
Numerical Methods in Fluids 19 (1994), 369–375. Needs python3-numpy, and python3-netcdf4 or python3-scipy."""
import numpy
from oval4d_client import connect

A, D = numpy.pi / 4, numpy.pi / 2  # the parameters a and d in the paper of Ethier and Steinman
FILE = "ethier_steinman.nc"
SIZE, MOMENTS, DURATION = 48, 24, 0.6  # samples along each of x, y and z; number of moments; time of the last moment


def velocity(x, y, z, t):
    """Returns the three components of the velocity at the point (x, y, z) and the time t, for the viscosity 1."""
    def component(p, q, r):
        return -A * (numpy.exp(A * p) * numpy.sin(A * q + D * r) + numpy.exp(A * r) * numpy.cos(A * p + D * q))

    decay = numpy.exp(-(D**2) * t)
    return component(x, y, z) * decay, component(y, z, x) * decay, component(z, x, y) * decay


def create_netcdf(path):
    """Creates a NetCDF file with netCDF4 or, if this library is not installed, with scipy. Returns the file, and a
    function that adds a variable of 32-bit floats to it."""
    try:
        from netCDF4 import Dataset
        file = Dataset(path, "w", format="NETCDF3_64BIT_OFFSET")
    except ImportError:
        from scipy.io import netcdf_file
        file = netcdf_file(path, "w", version=2)

    def add(name, dimensions, values, **attributes):
        variable = file.createVariable(name, "f4", dimensions)
        for attribute, value in attributes.items():
            setattr(variable, attribute, value)
        variable[:] = values

    return file, add


def write_speed(path):
    space, time = numpy.linspace(-1, 1, SIZE), numpy.linspace(0, DURATION, MOMENTS)
    t, z, y, x = numpy.meshgrid(time, space, space, space, indexing="ij")
    file, add = create_netcdf(path)
    for name, values in (("t", time), ("z", space), ("y", space), ("x", space)):
        file.createDimension(name, len(values))
        add(name, (name,), values, axis=name.upper(), units="1")
    speed = numpy.sqrt(sum(part**2 for part in velocity(x, y, z, t)))
    add("speed", ("t", "z", "y", "x"), speed, long_name="speed of the flow", units="1")
    file.close()


write_speed(FILE)
with connect("http://127.0.0.1:8080/") as oval:
    oval.hello()
    with open(FILE, "rb") as data:
        for warning in oval.upload("Ethier–Steinman", data, "netcdf", variable="speed").get("warnings", []):
            print(warning)
    oval.set(levels=[1.2, 0.8], color="growth", slices={"count": 11, "spacing": 0.19})
    oval.rotate("xw", 0.3)
    with open("ethier_steinman.png", "wb") as picture:
        picture.write(oval.frame(1280, 720))
