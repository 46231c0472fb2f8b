#!/usr/bin/env python3
"""What the Python module costs: calls, copies and the import.

Prints the median time of planes() for 10 000 points, and for 10 000 points on one line, which hold no answer: what
is left is the call, the check of the array and the copy; how much memory planes() takes beside an array of ten million rows;
and the time of the import.

example: PYTHONPATH=build/src/python /usr/bin/python3 test/benchmark/python_calls.py
"""
import resource
import statistics
import subprocess
import sys
import timeit

import numpy
import pcl_symmetry


def surface(num_points):
    """Points on the surface of a box, (num_points, 3) float32."""
    points = numpy.random.default_rng(1).normal(size=(num_points, 3))
    points /= numpy.abs(points).max(axis=1, keepdims=True)
    return (points * (1.0, 0.8, 0.5)).astype(numpy.float32)


def main():
    if len(sys.argv) != 1:
        sys.exit(__doc__)
    box = surface(10_000)
    line = box * numpy.float32([1, 0, 0])
    for words, points in (("points", box), ("points on a line", line)):
        times = timeit.repeat(lambda points=points: pcl_symmetry.planes(points, viewpoint=None), number=1, repeat=102)
        milliseconds = 1e3 * statistics.median(times[1:])  # the first one starts the threads
        print(f"planes of 10 000 {words}: {milliseconds:.2f} ms")
    many = numpy.tile(box, (1000, 1))
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    pcl_symmetry.planes(many, viewpoint=None)
    grown = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024
    print(f"array of {many.nbytes / 2**20:.0f} MB, 10 million rows: {grown:.0f} MB more at the peak")
    code = "import time; t = time.perf_counter(); import pcl_symmetry; print(time.perf_counter() - t)"
    times = [float(subprocess.check_output([sys.executable, "-c", code])) for _ in range(9)]
    print(f"import pcl_symmetry: {1e3 * statistics.median(times):.1f} ms")


if __name__ == "__main__":
    main()
