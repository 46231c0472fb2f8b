"""Is one build faster than another, and by how much? Both builds are of the preset "benchmark".

Runs the stages of benchmark_speed with one thread, and a fresh process of pcl_symmetry_planes for each FILE, in both builds in
turn on one core, and prints the least processor time of each row in milliseconds and the ratio of the two: below 1, AFTER
is faster. The ratios of single rounds, from the least to the greatest, tell how much other programs disturb.

example: ratio.py ../before/build-benchmark build-benchmark cow.off
"""
from pathlib import Path

import bench

NUM_ROUNDS = 5
ROWS = "^(Edt|Sampled|Planes|Rotations|Description|Segmentation|Registration|NearestViews).*/threads:1($|/)"
ON_ONE_CORE = ["taskset", "-c", "0"]


def times_of(build, files):
    """Milliseconds of processor time by row."""
    found = bench.google_benchmark([*ON_ONE_CORE, f"{build}/test/benchmark/benchmark_speed"], f"--benchmark_filter={ROWS}")
    times = {each["name"]: each["cpu_ms"] for each in found}
    for file in files:
        command = ["/usr/bin", *ON_ONE_CORE, f"{build}/apps/pcl_symmetry_planes", file, "-threads", "1", "-quiet"]
        _, times[f"pcl_symmetry_planes {Path(file).name}"] = bench.timed(bench.run_tool, *command, clock=bench.seconds_of_children)
    return times


def report(options):
    rounds = [[times_of(build, options.files) for build in (options.before, options.after)] for _ in range(NUM_ROUNDS)]
    print(f"{'row, processor time in ms':60} {'before':>9} {'after':>9} {'ratio':>6}  of single rounds")
    for row in rounds[0][1]:
        pairs = [(before[row], after[row]) for before, after in rounds if row in before]
        if not pairs:
            continue
        before, after = (min(times) for times in zip(*pairs))
        ratios = sorted(b / a for a, b in pairs)
        print(f"{row:60} {before:9.2f} {after:9.2f} {after / before:6.2f}  {ratios[0]:.2f} to {ratios[-1]:.2f}")


if __name__ == "__main__":
    parser = bench.plain_parser(__doc__)
    parser.add_argument("before", help="build folder")
    parser.add_argument("after", help="build folder")
    parser.add_argument("files", nargs="*", help="clouds or meshes for the fresh processes")
    bench.main(report, parser.parse_args())
