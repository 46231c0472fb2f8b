"""The JSON that the tools write follows the schemas in apps/schemas. Without python3-jsonschema the test is skipped (77)."""

import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    import jsonschema
except ImportError:
    print("skipped: the Debian package python3-jsonschema is not installed for " + sys.executable)
    sys.exit(77)

USAGE = "usage: python3 test/tools/check_schemas.py APPS SCHEMAS\nAPPS: folder of the tools, SCHEMAS: apps/schemas."


def prism(sides, height):
    """A prism with a regular polygon of unit radius as its base, as OFF."""
    corners = [(math.cos(2 * math.pi * k / sides), math.sin(2 * math.pi * k / sides)) for k in range(sides)]
    vertices = [f"{x} {y} {z}" for z in (-height, height) for x, y in corners]
    faces = [[sides, *range(sides)], [sides, *range(sides, 2 * sides)]]
    faces += [[4, k, (k + 1) % sides, sides + (k + 1) % sides, sides + k] for k in range(sides)]
    lines = ["OFF", f"{len(vertices)} {len(faces)} 0", *vertices, *(" ".join(map(str, face)) for face in faces)]
    return "\n".join(lines) + "\n"


class Checker:
    def __init__(self, apps, schemas):
        self.apps = Path(apps)
        self.validators = {}
        for path in sorted(Path(schemas).glob("*.schema.json")):
            schema = json.loads(path.read_text())
            jsonschema.Draft202012Validator.check_schema(schema)
            self.validators[path.name.split(".")[0]] = jsonschema.Draft202012Validator(schema)
        self.unused = set(self.validators)

    def run(self, arguments, schema=None, status=0, lines=False):
        """Runs a tool; the last argument is the JSON file where a schema is given."""
        tool, *rest = arguments
        if schema is not None:
            Path(rest[-1]).unlink(missing_ok=True)
        done = subprocess.run([self.apps / f"pcl_symmetry_{tool}", *rest], capture_output=True, text=True)
        if done.returncode != status:
            sys.exit(f"{tool} {' '.join(rest)}: exit status {done.returncode}, {done.stderr}")
        if schema is None:
            return
        self.unused.discard(schema)
        if not Path(rest[-1]).exists():
            sys.exit(f"{tool} {' '.join(rest)}: no JSON was written")
        text = Path(rest[-1]).read_text()
        for document in map(json.loads, text.splitlines() if lines else [text]):
            if schema != "models_info" and not {"tool", "version", "options"} <= set(document.get("made_by", ())):
                sys.exit(f"{tool} {' '.join(rest)}: the JSON does not say how it was made")
            for error in self.validators[schema].iter_errors(document):
                sys.exit(f"{tool} {' '.join(rest)}: against {schema}.schema.json: {error.json_path}: {error.message}")
        print(f"{tool}: {schema}")


def main(apps, schemas):
    check = Checker(apps, schemas)
    with tempfile.TemporaryDirectory() as folder:
        at = lambda name: str(Path(folder) / name)
        for name, text in [("box.off", prism(4, 0.4)), ("can.off", prism(96, 1.5)), ("bad.off", "x")]:
            Path(at(name)).write_text(text)
        ball = "".join(
            f"{math.sin(a) * math.cos(b)} {math.sin(a) * math.sin(b)} {math.cos(a)}\n"
            for a, b in ((math.acos(1 - 2 * (i + 0.5) / 3000), 2.399963 * i) for i in range(3000))
        )
        Path(at("ball.xyz")).write_text(ball)
        few = ["-quiet", "-points", "2000"]
        check.run(["planes", at("box.off"), *few, "-json", at("a.json")], "planes")
        names = [at(name) for name in ("box.off", "can.off", "ball.xyz", "bad.off")]
        check.run(["planes", *names, *few, "-approximate", "-json", at("b.json")], "planes", status=1, lines=True)
        check.run(["viewpoint", at("box.off"), *few, "-json", at("a.json")], "views")
        check.run(["segment", at("box.off"), "-quiet", "-json", at("a.json")], "segments")
        check.run(["map", at("box.off"), *few, "-json", at("a.json")], "map")
        check.run(["scan", at("box.off"), at("scan.pcd"), "-quiet", "-json", at("a.json")], "scans")
        check.run(["scene", at("scan.pcd"), "-quiet", "-max_points", "1000", "-json", at("a.json")], "scene")
        check.run(["align", at("box.off"), *few, "-json", at("a.json")], "frame")
        for tool, schema in (("align", "frame"), ("planes", "planes")):
            check.run([tool, at("scan.pcd"), *few, "-json", at("a.json")], schema)
        check.run(["align", at("scan.pcd"), *few, "-target", at("box.off"), "-json", at("a.json")], "pose")
        check.run(["align", at("scan.pcd"), at("scan.pcd"), "-quiet", "-merge", at("all.pcd"), "-json", at("a.json")], "merged")
        check.run(["bop", at("box.off"), at("can.off"), "-quiet", "-json", at("a.json")], "models_info")
        turn = [0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
        axis = {"axis": [0, 0, 1], "offset": [0, 0, 0]}
        given = {"1": {"symmetries_discrete": [turn]}, "2": {"symmetries_continuous": [axis]}}
        Path(at("given.json")).write_text(json.dumps(given))
        models = [at(name) for name in ("box.off", "can.off", "prism.off")]
        Path(models[2]).write_text(prism(5, 0.4))
        check.run(["bop", *models, "-check", at("given.json"), "-quiet", "-report", at("a.json")], "bop_check")
        report = json.loads(Path(at("a.json")).read_text())
        assert report["missing"] == ["3"] and report["disagreeing"] == 2, report
        base = [at("models.db"), "-quiet"]
        check.run(["database", "build", at("models.db"), at("box.off"), at("can.off"), *few, "-json", at("a.json")], "database_build")
        check.run(["database", "list", *base, "-json", at("a.json")], "database_models")
        check.run(["database", "info", *base, "-json", at("a.json")], "database_info")
        check.run(["database", "check", *base, "-json", at("a.json")], "database_check")
        check.run(["match", at("models.db"), at("can.off"), "-quiet", "-json", at("a.json")], "match")
        check.run(["match", at("models.db"), at("can.off"), "-recognize", "-quiet", "-json", at("a.json")], "recognition")
    if check.unused:
        sys.exit("no tool was held to " + ", ".join(sorted(check.unused)))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        print(USAGE)
        sys.exit(0 if "-h" in sys.argv or "--help" in sys.argv else 2)
    main(*sys.argv[1:])
