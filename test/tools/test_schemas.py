"""The JSON that the tools write follows the schemas in apps/schemas."""
import json

from tool_run import SCHEMAS, ToolTest, lathe, pcd, points_on_sphere

FEW = "-quiet -points 2000"
# Tool and arguments, and the schema of what it writes.
RUNS = ((f"planes box.off {FEW}", "planes"), (f"planes box.off {FEW} -as_published", "planes"), (f"planes scan.pcd {FEW}", "planes"), (f"viewpoint box.off {FEW}", "views"),
        ("segment box.off -quiet", "segments"), (f"map box.off {FEW}", "map"), ("scan box.off scan.pcd -quiet", "scans"),
        ("scene scan.pcd -quiet -max_points 1000", "scene"), (f"align box.off {FEW}", "frame"), (f"align scan.pcd {FEW}", "frame"),
        (f"align scan.pcd {FEW} -target box.off", "pose"), ("align scan.pcd scan.pcd -quiet -merge all.pcd", "merged"),
        ("bop box.off can.off -quiet", "models_info"), (f"database build models.db box.off can.off {FEW}", "database_build"),
        ("database list models.db -quiet", "database_models"), ("database info models.db -quiet", "database_info"),
        ("database check models.db -quiet", "database_check"), ("match models.db can.off -quiet", "match"),
        ("match models.db can.off -recognize -quiet", "recognition"))


class Schemas(ToolTest):
    def setUp(self):
        super().setUp()
        for name, sides, height in (("box", 4, 0.4), ("can", 96, 1.5), ("prism", 5, 0.4)):
            self.write(name + ".off", lathe([(0.001, -height), (1, -height), (1, height), (0.001, height)], sides))
        self.run_tool("box.off scan.pcd -quiet", tool="scan")

    def assert_follows(self, document, schema):
        super().assert_follows(document, schema)
        if schema != "models_info":
            self.assertLessEqual({"tool", "version", "options"}, set(document["made_by"]))

    def test_are_followed(self):
        for run, schema in RUNS:
            with self.subTest(run):
                tool, arguments = run.split(" ", 1)
                self.assert_follows(self.report(arguments, tool=tool), schema)
        self.assertEqual({schema for _, schema in RUNS} | {"bop_check"}, {path.name.split(".")[0] for path in SCHEMAS.glob("*.json")}, "each is held to")

    def test_are_followed_line_by_line(self):
        self.write("ball.pcd", pcd(points_on_sphere(3000)))
        self.write("bad.off", "x")
        self.run_tool(f"box.off can.off ball.pcd bad.off {FEW} -approximate -json a.jsonl", tool="planes", code=1)
        for line in self.lines("a.jsonl"):
            self.assert_follows(line, "planes")

    def test_are_followed_by_checks_of_given_symmetries(self):
        turn = [0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
        given = {"1": {"symmetries_discrete": [turn]}, "2": {"symmetries_continuous": [{"axis": [0, 0, 1], "offset": [0, 0, 0]}]}}
        self.write("given.json", json.dumps(given))
        self.run_tool("box.off can.off prism.off -check given.json -quiet -report a.json", tool="bop")
        report = json.loads(self.text("a.json"))
        self.assert_follows(report, "bop_check")
        self.assertEqual((report["missing"], report["disagreeing"]), (["3"], 2))
