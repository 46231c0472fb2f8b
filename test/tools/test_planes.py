"""The tool of planes, and what it shows of all tools: standard streams, names, full disks."""
import json
import os
import subprocess
from pathlib import Path

from tool_run import BOX_FACES, CYLINDER, SPHERE, TETRAHEDRON, TOOLS, ToolTest, box_corners, box_off, lathe, mug, np, off, pcd
from tool_run import pcd_header, ply_points, points_on_box, points_on_sphere, rotation, xyz


class Planes(ToolTest):
    tool = "planes"
    flags = "-quiet -points 2000"
    files = dict(box=("box.off", box_off()), tetrahedron=("t.off", TETRAHEDRON))

    def test_writes_the_profile_of_a_body_of_revolution(self):
        vase = self.write("vase.off", lathe([(0.5, 0), (0.7, 0.3), (0.5, 0.8), (0.3, 1.0), (0.4, 1.4)], 90))
        self.run_tool(vase, "-profile p.csv")
        header, *rows = self.text("p.csv").splitlines()
        self.assertEqual(header, "radius,height,spread,count")
        self.assertGreater(len(rows), 60)
        self.assertAlmostEqual(max(float(row.split(",")[0]) for row in rows), 0.7, delta=0.02)
        self.run_tool(vase, "-profile p.svg")
        self.assertTrue(self.text("p.svg").startswith("<svg "))
        self.run_tool(vase, "-profile p.txt", code=2)
        self.fails(1, "no body of revolution", self.box, "-profile p.csv")

    def test_reports_the_three_planes_of_a_box(self):
        report = self.report(self.box)
        self.assertEqual([plane["kind"] for plane in report["planes"]], 3 * ["symmetry"])
        self.assertEqual([report["axes"], report["centers"], report["partial"]], [[], [], False])
        self.assertTrue(report["timing_ms"]["total"] > 0 and "symmetry" in self.output)
        plane = self.report(self.box, "-as_published -points 1000 -csv a.csv")["planes"][0]
        self.assertEqual((plane["kind"], plane["confidence"]), ("approximate", 0))
        self.assertEqual([plane[name] for name in ("share", "share_interval", "deviation")], [None, [None, None], None], "not measured")
        self.assertRegex(self.output.splitlines()[1], " -       - .* approximate$")
        self.assertRegex(self.text("a.csv").splitlines()[1], "approximate,.*,0.0,,.*,1.0,$")

    def test_tells_the_best_plane_where_all_are_doubted(self):
        """On a ground that its plane slants against, a box in noise keeps no plane; the nearest to one is still reported."""
        body = self.write("body.off", off(box_corners(1, 0.7, 0.45), BOX_FACES))
        self.run_tool(body, "scan.pcd -direction 1,1.3,0.9 -noise 0.003", tool="scan")
        self.assertEqual(len(self.report("scan.pcd", "-tolerance 0.002")["planes"]), 1)
        report = self.report("scan.pcd", "-tolerance 0.002 -ground 1,1,1,4")
        self.assertTrue(report["planes"] == [] and report["best"])

    def test_exchanging_the_ends_of_a_mug_is_possible_at_most(self):
        """From above, the inside shows through the opening: whether the bottom is open, too, was not seen."""
        cup = self.write("mug.off", off(*mug()))
        for direction in ("1,-1,1", "1,1,0.7"):
            self.run_tool(cup, f"scan.pcd -direction {direction} -quiet", tool="scan")
            planes = self.report("scan.pcd", "-explain")["planes"]
            handle, *others = [abs(plane["coefficients"][1]) for plane in planes if plane["kind"] == "symmetry"]
            self.assertTrue(handle > 0.99 and not others, direction)
            self.assertIn("the inside of a hollow body was seen through one end alone", self.output)

    def test_planes_beside_the_axis_of_a_bowl_are_possible_at_most(self):
        angles = np.linspace(0.01, np.pi / 2, 16)
        outside = [(np.sin(angle), -np.cos(angle)) for angle in angles]
        bowl = self.write("bowl.off", lathe(outside + [(0.92 * r, 0.92 * z) for r, z in outside[::-1]], 96))
        self.run_tool(bowl, "scan.pcd -direction 0.3,1,0.5 -noise 0.002 -quiet", tool="scan")
        report = self.report("scan.pcd", "-explain")
        self.assertEqual(len(report["axes"]), 1)
        self.assertEqual([plane["kind"] for plane in report["planes"]], ["possible"])
        self.assertIn("neither contains nor is perpendicular to an axis of revolution", self.output)

    def test_keeps_coordinates_beyond_float_precision(self):
        """A box of 1 x 0.8 x 0.6 m at map coordinates, where the spacing of float is half a meter; its planes are oblique."""
        half, middle, turn = (0.5, 0.4, 0.3), np.array([500000.3, 5000000.7, 100.2]), rotation((1, 2, 3), 0.7)
        far = self.write("far.off", off(box_corners(*half) @ turn.T + middle, BOX_FACES))
        planes = self.report(far, "-support s.ply")["planes"]
        table = [line.split() for line in self.output.splitlines()]
        for plane, row in zip(planes, table[1:], strict=True):
            for coefficients, limit in ((plane["coefficients"], 1e-3), (np.array(row[1:5], float), 2e-5)):  # printed: few digits
                self.assertAlmostEqual(coefficients @ np.append(middle, 1), 0, delta=limit, msg="through the middle of the box")
        along = abs(np.array([plane["coefficients"][:3] for plane in planes]) @ turn) > 0.99
        np.testing.assert_array_equal(along.sum(axis=0), [1, 1, 1])
        points, _ = ply_points(self.folder / "s.ply")
        self.assertEqual(points["x"].dtype, np.float64)
        self.assertLess((abs((xyz(points)[0] - middle) @ turn) - half).max(), 1e-6, "on the box, in the input frame")

    def test_says_none(self):
        answer = self.report(self.tetrahedron, "-quiet")
        self.assertTrue(self.output.startswith("no symmetry plane\nbest plane "), self.output)
        self.assertNotIn("leave it open", self.output)
        self.assertEqual((self.error, answer["planes"], answer["undecided"]), ("", [], False))
        self.assertTrue(answer["best"]["share"] < 0.9 and answer["best"]["deviation"] > answer["tolerance"])
        self.assertIn("approximate", self.run_tool(self.tetrahedron, "-quiet --approximate"))
        self.run_tool(self.write("few.pcd", pcd(points_on_sphere(100))), "-points 200")
        self.assertRegex(self.output, r"the points leave it open: the share of the whole surface is between \d+ and 100 %")
        self.assertIn("-points is of meshes", self.error)
        self.assertTrue(self.report("few.pcd")["undecided"])
        self.run_tool("few.pcd -csv few.csv")
        self.assertIn(",undecided,", self.text("few.csv"))

    def test_a_label_names_the_object_in_its_scene(self):
        random = np.random.default_rng(3)
        points = random.uniform(-0.5, 0.5, (600, 3)) * (1, 0.8, 0.6) + np.repeat([[0, 0, 0], [4, 0, 0]], 300, axis=0)
        cloud = self.write("l.pcd", pcd(points, label=np.where(points[:, 0] < 1, 3, 8)))
        self.assertEqual(self.report(cloud, "-label 3 -viewpoint none")["num_points"], (points[:, 0] < 1).sum())
        self.fails(1, "l.pcd: has no point with the label 4", cloud, "-label 4")
        self.fails(1, "has no field label", self.write("n.pcd", pcd(points)), "-label 3")
        self.fails(1, "-label needs a cloud", self.box, "-label 3")

    def test_writes_the_support_of_every_point_and_keeps_its_fields(self):
        points = np.vstack([3 * [np.nan], points_on_box((2, 3, 4), 1200)])
        cloud = self.write("c.pcd", pcd(points, viewpoint=(1, 2, 3), label=np.arange(len(points))))
        planes = self.report(cloud, "-support s.pcd")["planes"]
        self.assertGreaterEqual(len(planes), 1)
        header = pcd_header(self.folder / "s.pcd")
        self.assertCountEqual(header["FIELDS"], ["x", "y", "z", "label", *(f"support_{k + 1}" for k in range(len(planes)))])
        self.assertEqual([header["POINTS"], header["VIEWPOINT"][:3]], [["1201"], ["1", "2", "3"]])
        self.run_tool(cloud, "-support s.ply")
        support = ply_points(self.folder / "s.ply")[0]["support_1"]
        self.assertTrue(np.isnan(support[0]))
        self.assertGreater(support[1:].mean(), 0.9)

    def test_reports_an_axis_of_revolution(self):
        report = self.report(self.write("cylinder.off", CYLINDER), "-explain")
        self.assertEqual([len(report[key]) for key in ("axes", "centers", "planes")], [1, 0, 1])
        axis = report["axes"][0]
        self.assertGreater(abs(axis["direction"][2]), np.cos(0.01))
        self.assertLess(np.hypot(*axis["point"][:2]), 0.01)
        self.assertRegex(self.output, "axis of revolution: confidence 0[.].*\n  planes at eight angles through it together: support [01][.]")
        self.assertIn(": 1 plane, 1 axis]", self.error)
        ball = self.report(self.write("ball.off", SPHERE))
        self.assertEqual([len(ball[key]) for key in ("axes", "centers", "planes")], [0, 1, 0])
        np.testing.assert_allclose(ball["centers"][0]["point"], 0, atol=0.01)

    def test_answers_bad_input_with_one_line_and_an_exit_code(self):
        one = self.write("one.pcd", pcd([(1, 2, 3), (1, 2, 3)]))
        self.fails(1, "one.pcd", one, "-quiet -json never.json")
        self.assertEqual(self.error.count("\n"), 1, self.error)
        self.assertFalse((self.folder / "never.json").exists())
        for output in ("-json", "-csv", "-support"):
            self.run_tool(self.box, f"{output} missing/out.pcd", code=1)
            self.assertEqual(self.output, "", "refused before the work")
        self.run_tool(self.box, "-quiet -json /dev/null")
        self.run_tool("--version")
        self.assertTrue(self.output.startswith("pcl_symmetry_planes "), self.output)
        self.run_tool(code=2)

    def test_reads_standard_input_and_writes_standard_output(self):
        content = self.box.read_bytes()
        for flags, start in (("", "plane"), ("-support -", "# .PCD"), ("-csv -", "file,number")):
            self.run_tool("-", self.flags, flags, input=content)
            self.assertTrue(self.output.lstrip().startswith(start), self.output[:200])
        self.run_tool("-", self.flags, "-json -", input=content)
        self.assertEqual(json.loads(self.output)["file"], "-")

    def test_takes_names_in_any_language(self):
        """Names in UTF-8, and bytes that are none: file names are bytes."""
        for name in ("куб 1", os.fsdecode(b"no \xff text"), "'quotes' & more"):
            path = self.write(f"Würfel 立方/{name}.off", self.box.read_bytes())
            outputs = {flag: Path(f"{path.with_suffix('')}{ending}") for flag, ending in
                       (("-json", ".json"), ("-csv", ".csv"), ("-support", "_support.ply"), ("-html", ".html"))}
            self.run_tool(path, self.flags, *(word for pair in outputs.items() for word in pair))
            self.assertEqual(len(json.loads(outputs["-json"].read_bytes())["planes"]), 3, name)
            self.assertEqual(len(ply_points(outputs["-support"])[0]), 2000, name)
            self.assertGreater(outputs["-html"].stat().st_size, 0, name)
        self.run_tool(self.folder / "Würfel 立方", self.flags)
        self.assertEqual(self.output.count("\n"), 6, "three boxes, three clouds with support")

    def test_says_that_standard_output_is_full(self):
        for flags in ("-json -", "-csv -", "-support -", ""):
            with open("/dev/full", "w", encoding="utf-8") as full:
                done = subprocess.run([TOOLS / "pcl_symmetry_planes", self.box, *self.flags.split(), *flags.split()],
                                      stdout=full, stderr=subprocess.PIPE, check=False)
            self.assertEqual((done.returncode, b"standard output" in done.stderr), (1, True), flags)
