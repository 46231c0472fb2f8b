"""The JSON that the evaluator writes follows the schemas in apps/schemas/evaluate; without python3-jsonschema skipped (77)."""

import sys
import tempfile
from pathlib import Path

from check_schemas import Checker, prism

USAGE = "usage: python3 test/apps/schemas/check_evaluator_schemas.py APPS SCHEMAS\nAPPS: folder of the tools, SCHEMAS: apps/schemas/evaluate."


def main(apps, schemas):
    check = Checker(apps, schemas)
    with tempfile.TemporaryDirectory() as folder:
        at = lambda name: str(Path(folder) / name)
        for name in ("meshes", "two", "cut", "people"):
            Path(at(name)).mkdir()
        # Two models of each class, so that each has one to be found by; named as the two benchmarks name theirs.
        meshes = {"1": prism(4, 0.4), "2": prism(4, 0.6), "3": prism(5, 1.5), "4": prism(5, 1.2)}
        for name, mesh in meshes.items():
            Path(at(f"meshes/m{name}.off")).write_text(mesh)
            if name in ("1", "3"):
                Path(at(f"two/m{name}.off")).write_text(mesh)
            Path(at(f"cut/{name}.off")).write_text(mesh)
            faces = int(mesh.splitlines()[1].split()[1])
            Path(at(f"people/{name}")).mkdir()
            Path(at(f"people/{name}/{name}_0.seg")).write_text("".join(f"{int(k > 1)}\n" for k in range(faces)))
        classes = ["PSB 1", "2 4", "", "low 0 2", "1", "2", "", "high 0 2", "3", "4", ""]
        Path(at("two.cla")).write_text("\n".join(classes))
        models, two, result = at("meshes"), at("two"), ["-quiet", "-json", at("a.json")]
        run = lambda command, *rest: check.run(["evaluate", command, *rest, *result], f"evaluate_{command}")
        run("planes", two, "-points", "1000", "-rows", "whole", "-references", at("references.json"))
        run("alignment", two, "-points", "1000", "-num_views", "1")
        run("recognition", two, "-points", "1000")
        run("registration", two, "-points", "1000", "-num_views", "1", "-methods", "pca", "-references", at("references.json"))
        run("retrieval", models, "-cla", at("two.cla"), "-points", "1000", "-database")
        run("rotations", "-counts", "500", "-noise", "0", "-kind", "nuts")
        run("segmentation", at("cut"), at("people"), "-methods", "one", "-categories")
        run("scenes", two, "-scenes", "1", "-objects", "2", "-noise", "0", "-references", at("references.json"))
        run("shapes", "random", "-num", "2", "-points", "200")
    if check.unused:
        sys.exit("the evaluator was not held to " + ", ".join(sorted(check.unused)))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        print(USAGE)
        sys.exit(0 if "-h" in sys.argv or "--help" in sys.argv else 2)
    main(*sys.argv[1:])
