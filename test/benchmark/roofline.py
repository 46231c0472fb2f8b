"""How near is each stage to what this machine can do?

The least time of a stage is the sum of the steps that its result needs whatever the algorithm (look-ups, nearest points,
bytes), each at the speed at which a loop of nothing else runs it here. Prints processor times of one thread, the least of three.

example: roofline.py build-benchmark/test/benchmark/benchmark_speed
"""
import bench

STEPS = {  # counter of a stage: benchmark of the machine
    "look_up": ("look-ups", "Machine_look_up"),
    "trilinear": ("look-ups between eight values", "Machine_trilinear"),
    "exponential": ("exponentials", "Machine_exponential"),
    "nearest": ("nearest of 32 points", "Machine_nearest/of:32/kept:1"),
    "nine_nearest": ("nine nearest of 64", "Machine_nearest/of:64/kept:9"),
    "byte_near": ("bytes of the cache", "Machine_byte/kB:256"),
    "byte_far": ("bytes of memory", "Machine_byte/kB:262144"),
}
STAGES = {
    "Edt/points:10000/cells:64/threads:1": "distance transform",
    "Sampled/theta:64/phi:64/samples:512/threads:1": "transform of 64 x 64 x 64 planes, 512 samples",
    "Sampled/theta:32/phi:128/samples:64/threads:1": "transform of 32 x 128 x 64 planes, 64 samples",
    "Planes/points:10000/threads:1": "planes of a whole cloud",
    "PlanesOfScan/rotations:0/threads:1": "planes of a scan",
    "PlanesOfScan/rotations:1/threads:1": "planes and rotations of a scan",
    "Rotations/threads:1": "rotations",
    "Description/threads:1": "description",
    "Segmentation/threads:1": "segmentation of a mesh",
    "Registration/threads:1": "registration",
    "NearestViews/threads:1": "recognition: views of 815 models",
}


def report(arguments):
    rows, wanted = {}, "--benchmark_filter=^Machine|^(" + "|".join(STAGES) + ")(/|$)"
    for _ in range(3):
        for row in bench.google_benchmark(arguments.benchmark, wanted, "--benchmark_min_time=0.2"):
            name = row["name"].replace("/process_time", "")
            row["cpu_ns"] = 1e6 * row["cpu_ms"]
            if name not in rows or row["cpu_ns"] < rows[name]["cpu_ns"]:
                rows[name] = row
    step_ns = {step: rows[name]["cpu_ns"] / rows[name]["steps"] for step, (_, name) in STEPS.items()}
    bench.print_table("Steps", ["step", "ns"], [[words, f"{step_ns[step]:.3g}"] for step, (words, _) in STEPS.items()])
    table = []
    for name, words in STAGES.items():
        row = rows[name]
        counts = {step: row.get(f"needs_{step}", 0.0) for step in STEPS}
        least = sum(count * step_ns[step] for step, count in counts.items())
        text = ", ".join(f"{count / 1000:.0f} {STEPS[step][0]}" for step, count in counts.items() if count >= 500)
        table.append([words, text, f"{1e-6 * least:.2f}", f"{1e-6 * row['cpu_ns']:.2f}", f"{100 * least / row['cpu_ns']:.0f} %"])
    bench.print_table("Stages", ["stage, one thread", "steps, thousands", "least ms", "measured ms", "share"], table)


if __name__ == "__main__":
    parser = bench.plain_parser(__doc__)
    parser.add_argument("benchmark", help="program benchmark_speed")
    bench.main(report, parser.parse_args())
