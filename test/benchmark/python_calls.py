"""What the Python module costs: calls, copies and the import.

usage: PYTHONPATH=build/src/python /usr/bin/python3 test/benchmark/python_calls.py BENCHMARK_CALLS

Prints the time of planes() for 10 000 points from Python and from C++ (BENCHMARK_CALLS is the program of that name, of
the preset "benchmark"), in turn, five times 40 calls each; how much memory planes() takes beside an array of ten
million rows; and the time of the import.
"""

import resource
import statistics
import subprocess
import sys
import tempfile
import time

import numpy
import pcl_symmetry

NUM_ROUNDS = 5  # chosen: with 40 calls each, medians of two runs on an idle machine differ by 0.1 ms
NUM_CALLS = 40  # chosen, see above


def surface(num_points):
    """Points on the surface of a box, (num_points, 3) float32."""
    points = numpy.random.default_rng(1).normal(size=(num_points, 3))
    points /= numpy.abs(points).max(axis=1, keepdims=True)
    return (points * (1.0, 0.8, 0.5)).astype(numpy.float32)


def median_milliseconds(points):
    """The median wall time of a call; the first one, which starts the threads, is left out."""
    times = []
    for _ in range(NUM_CALLS + 1):
        start = time.perf_counter()
        pcl_symmetry.planes(points, viewpoint=None)
        times.append(1e3 * (time.perf_counter() - start))
    return statistics.median(times[1:])


def print_calls(program):
    points = surface(10_000)
    python, cpp = [], []
    with tempfile.NamedTemporaryFile() as file:
        points.tofile(file.name)
        for _ in range(NUM_ROUNDS):
            python.append(median_milliseconds(points))
            cpp.append(float(subprocess.check_output([program, file.name, str(NUM_CALLS)])))
    more = [p - c for p, c in zip(python, cpp)]
    print(f"planes of 10 000 points: Python {statistics.median(python):.2f} ms, C++ {statistics.median(cpp):.2f} ms,")
    print(f"  difference of {NUM_ROUNDS} rounds: {', '.join(f'{each:.2f}' for each in more)} ms")


def print_memory():
    points = numpy.tile(surface(10_000), (1000, 1))
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    pcl_symmetry.planes(points, viewpoint=None)
    grown = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024
    print(f"array of {points.nbytes / 2**20:.0f} MB, 10 million rows: {grown:.0f} MB more at the peak")


def print_import():
    code = "import time; t = time.perf_counter(); import pcl_symmetry; print(time.perf_counter() - t)"
    times = [float(subprocess.check_output([sys.executable, "-c", code])) for _ in range(9)]
    print(f"import pcl_symmetry: {1e3 * statistics.median(times):.1f} ms")


if len(sys.argv) != 2:
    sys.exit(__doc__)
print_calls(sys.argv[1])
print_memory()
print_import()
