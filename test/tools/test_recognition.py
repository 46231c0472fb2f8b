"""The tools that describe shapes, keep models and find them again."""
import sqlite3
from pathlib import Path

from tool_run import TETRAHEDRON, VASE, ToolTest, box_off, np, pcd_header


class Recognition(ToolTest):
    files = dict(vase=("vase.off", VASE), box=("box.off", box_off()), other=("tetrahedron.off", TETRAHEDRON))

    def descriptors(self, name):
        """The values of a file of descriptors, a row each, and their field."""
        header = pcd_header(self.folder / name)
        shape = int(header["POINTS"][0]), int(header["COUNT"][0])
        body = (self.folder / name).read_bytes().split(b"DATA binary\n", 1)[1]  # zeros may follow
        return np.frombuffer(body, "<f4", shape[0] * shape[1]).reshape(shape), header["FIELDS"][0]


class Describe(Recognition):
    tool = "describe"

    def test_writes_signatures(self):
        self.run_tool("out", self.vase, self.box, "-points 2000")
        values, field = self.descriptors("out/vase.pcd")
        self.assertEqual((values.shape, field), ((2, 20736), "signature"))
        self.assertAlmostEqual((values[0].astype(float) ** 2).sum(), 1, delta=1e-4)
        once = (self.folder / "out/box.pcd").read_bytes()
        self.run_tool("out", self.box, "-points 2000 -threads 1")
        self.assertEqual((self.folder / "out/box.pcd").read_bytes(), once)

    def test_writes_the_papers_descriptors(self):
        """Their values are those of the module: test_depth_cameras."""
        least = {}
        for flags, kind, size in (("-type prst -input_axes", "prst", 32768), ("-type gedt", "gedt", 32768), ("-type prsd", "prsd", 1024),
                                  ("-type prst -equation_1", "prst", 32768)):
            self.run_tool("out", self.box, flags, "-points 2000")
            values, field = self.descriptors("out/box.pcd")
            self.assertEqual((values.shape, field), ((1, size), kind))
            least[flags] = values.min()
        self.assertTrue(least["-type prst -input_axes"] < 0.7 < least["-type prst -equation_1"], "1 / sqrt(2)")

    def test_writes_a_table_and_goes_on_where_it_stopped(self):
        flags = "-points 2000 -quiet -type prsd -csv t.csv"
        self.run_tool("out", self.box, flags)
        header, row = self.text("t.csv").splitlines()
        self.assertTrue(header.startswith("file,number,prsd_1,prsd_2,"))
        self.assertEqual((header.count(","), row.count(",")), (1025, 1025))
        values, _ = self.descriptors("out/box.pcd")
        self.assertEqual(np.float32(row.split(",")[2]), values[0, 0], "nine digits tell all floats apart")
        # A descriptor of the type that stands there is kept, whatever it is; one of another type is not.
        file = self.folder / "out/box.pcd"
        changed = values.copy()
        changed[0, 0] = 42
        file.write_bytes(file.read_bytes().replace(values.tobytes(), changed.tobytes()))
        self.run_tool("out", self.vase, self.box, flags, "-resume")
        self.assertEqual(self.text("t.csv").count("\n"), 3)
        self.assertIn("box.off,1,42,", self.text("t.csv"))
        self.run_tool("out", self.vase, self.box, "-points 2000 -quiet -type gedt -resume")
        self.assertEqual(self.descriptors("out/box.pcd")[1], "gedt")

    def test_says_what_is_wrong_and_does_the_rest(self):
        broken = self.write("broken.off", "OFF\n3 1 0\n0 0 0\n")
        self.fails(1, "broken.off", "out", broken, self.box, "-points 2000 -quiet")  # -quiet hides no failure
        self.assertTrue((self.folder / "out/box.pcd").exists())
        few = self.write("few.xyz", "0 0 0\n1 0 0\n0 1 0\n0 0 1\n")
        self.fails(1, "few.xyz: input cloud: 4 distinct points, at least 20 are needed", "out", few)
        self.fails(1, "names must differ", "out", self.box, self.write("other/box.off", box_off()))
        self.run_tool("out", self.box, "-type nonsense", code=2)


class Database(Recognition):
    tool = "database"

    def match(self, *arguments):
        return self.report(*arguments, tool="match")

    def test_build_ask_and_change(self):
        self.run_tool("build models.db", self.vase, self.box)
        self.fails(1, "nothing.off: no such file", "add models.db nothing.off", self.other)
        self.assertNotIn("1 models", self.error)
        self.assertEqual(self.run_tool("list models.db"), "box\ntetrahedron\nvase\n")
        matches = self.match("models.db", self.vase, "-max 2")["matches"]
        self.assertEqual((len(matches), matches[0]["name"]), (2, "vase"))
        answer = self.match("models.db", self.box, "-recognize")
        self.assertTrue(answer["known"])
        self.assertEqual((answer["models"][0]["name"], len(answer["models"][0]["transform"])), ("box", 16))
        np.testing.assert_allclose(np.array(self.output.split()[7:23], float), answer["models"][0]["transform"], atol=1e-5)
        self.assertNotIn("1 models", self.error)
        self.run_tool("remove models.db box vase")
        self.run_tool("rebuild models.db")
        answer = self.match("models.db", self.box, "-recognize -min_confidence 1")
        self.assertEqual(self.output, "unknown object\n")
        self.assertEqual(answer["reason"], "none of 1 reaches a confidence of 1")
        self.write("list.txt", "vase.off\nbox.off\nnothing.off\n")
        self.fails(1, "nothing.off: no such file", "models.db @list.txt -json o.jsonl -csv o.csv", tool="match")
        self.assertEqual([[m["name"] for m in line.get("matches", [])] for line in self.lines("o.jsonl")], [["tetrahedron"], ["tetrahedron"], []])
        self.assertEqual(self.text("o.csv").splitlines()[0], "file,model,distance")
        self.fails(1, "2 of them before", "models.db @list.txt -json o.jsonl -resume", tool="match")

    def test_go_on_take_folders_and_tell_what_they_hold(self):
        self.write("shapes/a.off", box_off())
        self.write("shapes/more/b.off", TETRAHEDRON)
        self.write("shapes/notes.txt", "mine")
        self.write("list.txt", f"# files\n{self.vase}\n{self.folder}/sha*\n")
        build = "build models.db -points 2000 -names path -unit m -tag thing shapes"
        self.run_tool(build)
        self.write("shapes/a.off", box_off() + "\n")
        built = self.report(build, "va*.off")
        self.assertEqual((built["added"], built["kept"]), (2, 1), "the file that changed and the new one")
        listed = self.report("list models.db -csv list.csv")
        self.assertEqual((self.output, listed["models"][1]["tags"]), ("a\nmore_b\nvase\n", ["thing"]))
        self.assertTrue(self.text("list.csv").startswith("name,points,time,source,checksum,tags\na,2000,"))
        self.run_tool("info models.db")
        self.assertTrue(self.output.startswith("models  3\nunit    m\n"), self.output)
        self.assertIn("vase.off", self.run_tool("info models.db vase"))
        self.run_tool("export models.db clouds")
        self.assertEqual(pcd_header(self.folder / "clouds/more_b.pcd")["POINTS"], ["2000"])
        self.run_tool("export models.db clouds a", code=1)  # files that are there stay
        self.run_tool("merge other.db models.db")
        self.run_tool("check other.db")
        whole = (self.folder / "other.db").read_bytes()
        self.write("damaged.db", whole[:len(whole) // 2] + b"x" * (len(whole) - len(whole) // 2))
        self.fails(1, "damaged.db: ", "check damaged.db -quiet")
        self.assertEqual((self.output, "check names" in self.error), ("", False))
        self.run_tool("build third.db @list.txt -points 2000")
        self.assertEqual(self.run_tool("list third.db"), "a\nb\nvase\n")

    def contents(self, name):
        """What a database holds of each model, but the time; and the number of its projection."""
        with sqlite3.connect(f"file:{self.folder / name}?immutable=1", uri=True) as connection:
            models = connection.execute("SELECT name, source, source_checksum, num_points, clouds.data, signatures.data, views.data "
                                        "FROM models JOIN clouds ON clouds.model = id JOIN signatures ON signatures.model = id "
                                        "JOIN views ON views.model = id ORDER BY name").fetchall()
            return models, connection.execute("SELECT count(*) FROM projections").fetchone()[0]

    def test_merges_parts(self):
        flags = "-points 2000 -quiet"
        self.run_tool("build one.db", self.vase, self.box, self.other, flags)
        self.run_tool("build first.db", self.vase, self.other, flags, "-part")
        self.run_tool("build second.db", self.box, flags, "-part")
        self.assertEqual(self.contents("first.db")[1], 0, "parts are not fitted")
        self.assertEqual(self.report("merge merged.db first.db second.db")["added"], 3)
        self.assertEqual(self.contents("merged.db"), self.contents("one.db"))
        merged, one = (self.match(file, self.box, "-points 2000")["matches"] for file in ("merged.db", "one.db"))
        self.assertEqual(merged, one)
        before = (self.folder / "merged.db").read_bytes()
        self.run_tool("build inches.db", self.box, flags, "-unit inch -part")
        self.fails(1, "inches.db: unit = 'inch', must be '' as in merged.db", "merge merged.db inches.db")
        self.fails(1, "unit = 'mm', must be 'inch' as in inches.db", "add inches.db", self.vase, "-unit mm")
        self.assertEqual((self.folder / "merged.db").read_bytes(), before, "what cannot be merged changes nothing")
        self.write("shapes/box.off", box_off())
        self.fails(1, "shapes: is a folder, must be a file", "merge new.db shapes")
        self.run_tool("merge new.db first.db inches.db", code=1)
        self.assertFalse(Path(self.folder / "new.db").exists())
