#!/usr/bin/python3
"""Writes a quaternion Julia set as an array: julia.py FILE.npy

The set contains the quaternions q = s + x i + y j + z k whose iterates under q -> q^2 + c stay bounded, for
c = -0.2 + 0.8 i. The value at q is a lower bound of the distance from q to the set: |q_n| log|q_n| / (2 |q_n'|), where
q_n is the last iterate (J. Hart, D. Sandin, L. Kauffman, "Ray tracing deterministic 3-D fractals", 1989). If |q_n| is
at most 1, the value is 0. Because c is a complex number, the values depend only on s, x and y^2 + z^2.
"""

import sys

import numpy

SAMPLES = 72  # the number of samples along each axis
REACH = 1.15
C = (-0.2, 0.8)
ITERATIONS = 12
ESCAPED = 1e3


def distance_bounds(s, x, n):
    """Returns the lower bounds of the distances from the quaternions s + x i + n j to the set."""
    derivative = numpy.ones(numpy.broadcast(s, x, n).shape, numpy.float32)
    s, x, n = (part.astype(numpy.float32) for part in numpy.broadcast_arrays(s, x, n))
    for _ in range(ITERATIONS):
        size = numpy.sqrt(s * s + x * x + n * n)
        goes_on = size < ESCAPED
        derivative = numpy.where(goes_on, 2 * size * derivative, derivative)
        s, x, n = (numpy.where(goes_on, then, now) for then, now in
                   ((s * s - x * x - n * n + C[0], s), (2 * s * x + C[1], x), (2 * s * n, n)))
    size = numpy.sqrt(s * s + x * x + n * n)
    return numpy.where(size > 1, size * numpy.log(numpy.maximum(size, 1)) / (2 * derivative), 0)


def main():
    axis = numpy.linspace(-REACH, REACH, SAMPLES)
    squares, place = numpy.unique(numpy.add.outer(axis ** 2, axis ** 2).round(9), return_inverse=True)
    values = distance_bounds(axis[:, None, None], axis[None, :, None], numpy.sqrt(squares)[None, None, :])
    # oval4d takes the axes of the array as t, z, y and x. Along them, s, x, y and z of the quaternion change.
    numpy.save(sys.argv[1], values[:, :, place.reshape(SAMPLES, SAMPLES)].astype(numpy.float32))


main()
