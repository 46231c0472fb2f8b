"""The tool of frames and poses, what it completes and what it makes symmetric."""
import json
import unittest

from test_scene import block
from tool_run import BOX_FACES, TETRAHEDRON, Image, ToolTest, box_corners, box_off, np, off, pcd
from tool_run import pcd_header, pcd_points, ply_points, ply_text, xyz

SEAT, BACK = ((0, 0, 0), (1, 1, 0.2)), ((0, 0.9, 1.1), (0.8, 0.1, 0.9))  # center and half size; one plane of symmetry, x = 0


def boxes(*parts):
    """Corners and faces of boxes: center and half size."""
    return (np.vstack([box_corners(*half) + center for center, half in parts]),
            [[corner + 8 * k for corner in face] for k in range(len(parts)) for face in BOX_FACES])


class Align(ToolTest):
    tool = "align"
    files = dict(chair=("chair.off", off(*boxes(SEAT, BACK))), box=("box.off", box_off()))

    def scan(self):
        """What a scanner sees of the chair, with normals that look to the scanner. Returns the file and where the chair stands."""
        scan = self.report(self.chair, "seen.ply -direction -0.6,-1,0.7 -points 4000 -random_pose -seed 5", tool="scan")["scans"][0]
        points = xyz(ply_points(self.folder / "seen.ply")[0])
        points = points[np.isfinite(points).all(axis=1)]
        normals = scan["viewpoint"] - points
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        columns = dict(zip(("normal_x", "normal_y", "normal_z"), normals.T), label=np.arange(len(points)))
        return self.write("scan.pcd", pcd(points, viewpoint=scan["viewpoint"], **columns)), np.reshape(scan["transform"], (4, 4))

    def points(self, name):
        return ply_points(self.folder / name)[0]

    def assert_reflected(self, points, first):
        """The points from the first one on are reflections of others in the plane x = 0 of the model."""
        added = xyz(points[first:])
        of = xyz(points)[points["reflected_of"][first:]] * (-1, 1, 1)
        self.assertLess(np.linalg.norm(added - of, axis=1).max(), 0.1)

    def test_turns_a_whole_into_its_frame(self):
        found = self.report(self.box, "out.pcd")
        self.assertIn("center", self.output)
        np.testing.assert_allclose(found["center"], 0, atol=0.03)
        turn = np.reshape(found["transform"], (4, 4))[:3, :3]
        self.assertAlmostEqual(np.linalg.det(turn), 1, delta=1e-9)
        self.assertGreater(abs(turn).max(axis=1).min(), np.cos(0.02), "axes of the box")
        np.testing.assert_allclose(found["axes"], turn, atol=1e-9, err_msg="axes are the rows of the transform")
        self.assertTrue(min(found["scores"]) > 0.5 and found["revolution_axis"] == -1)
        self.assertEqual(pcd_header(self.folder / "out.pcd")["POINTS"], ["10000"])
        self.assertNotEqual(self.report(self.box, "-as_published")["scores"], found["scores"])

    def test_keeps_coordinates_beyond_float_precision(self):
        center = np.array([500000.5, 5000000.4, 100.3])
        found = self.report(self.write("far.off", off(box_corners(0.5, 0.4, 0.3) + center, BOX_FACES)), "out.ply")
        np.testing.assert_allclose(found["center"], center, rtol=0, atol=0.01)
        self.assertLess(np.linalg.norm((np.reshape(found["transform"], (4, 4)) @ (*center, 1))[:3]), 0.02, "of the input frame")
        self.assertLess(np.linalg.norm(xyz(self.points("out.ply")), axis=1).max(), 0.75, "half of the diagonal is 0.71")

    def test_brings_a_scan_to_its_model(self):
        scan, model = self.scan()
        found = self.report(scan, "out.ply -target chair.off")
        self.assertTrue(found["converged"])
        transform = np.reshape(found["transform"], (4, 4))
        error = transform @ model
        self.assertGreater(np.trace(error[:3, :3]), 1 + 2 * np.cos(0.02), "the chair has no rotation of its own")
        self.assertLess(np.linalg.norm(error[:3, 3]), 0.03)
        self.assertLess(found["fitness"], 0.03 ** 2, "mean squared distance")
        before, after = pcd_points(scan), self.points("out.ply")
        self.assertEqual(len(before), len(after))
        turn = transform[:3, :3]
        np.testing.assert_allclose(xyz(after), xyz(before) @ turn.T + transform[:3, 3], atol=1e-4)
        normals = np.stack([before[f"normal_{c}"] for c in "xyz"], axis=1)
        np.testing.assert_allclose(np.stack([after["nx"], after["ny"], after["nz"]], axis=1), normals @ turn.T, atol=1e-4)
        np.testing.assert_array_equal(after["label"], before["label"], "other fields stay")
        viewpoint = np.array(pcd_header(scan)["VIEWPOINT"][:3], float)
        self.run_tool(scan, "out.pcd -quiet -target chair.off")
        moved = np.array(pcd_header(self.folder / "out.pcd")["VIEWPOINT"][:3], float)
        np.testing.assert_allclose(moved, turn @ viewpoint + transform[:3, 3], atol=1e-3)

    def turntable(self, model, *directions):
        """Scans of a model from around; where it stands in each."""
        names, places = [], []
        for k, (x, y) in directions:
            names.append(f"s{k}.pcd")
            seen = self.report(model, names[-1], f"-direction {x},{y},0.7 -points 4000 -random_pose -seed {k + 1}", tool="scan")["scans"][0]
            places.append(np.reshape(seen["transform"], (4, 4)))
        return names, places

    def test_merges_scans(self):
        """Of the chair from four sides, of which the fourth slides on the others and is left out, and one of the box."""
        names, places = self.turntable(self.chair, *enumerate([(-0.6, -1), (0.3, -1), (1, -0.4), (1, 0.6)]))
        names += self.turntable(self.box, (4, (-0.6, -1)))[0]
        found = self.report(*names, "-merge all.ply -png all.png")
        self.assertEqual(["left_out" in scan for scan in found["scans"]], [False] * 3 + [True] * 2)
        for scan, place in zip(found["scans"][:3], places):
            np.testing.assert_allclose(np.linalg.solve(places[0], np.reshape(scan["transform"], (4, 4)) @ place), np.eye(4), atol=0.03)
            self.assertTrue(0.5 <= scan["confidence"] <= 1, scan)
        corner = np.asarray(Image.open(self.folder / "all.png").convert("RGB"), int)[-120:, :20]
        for color in ((230, 158, 0), (0, 115, 178), (0, 158, 115)):
            self.assertTrue((abs(corner - color).max(axis=2) <= 2).any(), f"{color} is in the legend")
        count, cube = len(self.points("all.ply")), found["resolution"]
        self.assertEqual(self.output.splitlines()[-1], f"3 of 5 scans, {count} points, one in each cube of {cube:.3g}")
        self.assertEqual(set(self.points("all.ply")["scan"]), set(range(3)))
        self.fails(1, "none.ply: is not written, as no two of the scans fit", names[0], names[4], "-merge none.ply -json none.json")
        self.assertEqual(["left_out" in scan for scan in json.loads(self.text("none.json"))["scans"]], [False, True])
        self.assertFalse((self.folder / "none.ply").exists())
        self.write("more.pcd", pcd(np.eye(3), intensity=np.ones(3)))
        self.fails(1, "more.pcd: has other fields than s0.pcd", names[0], "more.pcd", "-merge none.ply")
        self.assertNotIn("Registering", self.output)
        self.fails(2, "-merge and -target", *names[:2], "-merge all.ply -target chair.off")
        self.fails(2, "-merge FILE brings several scans together", *names)
        self.fails(2, "unexpected argument", names[0], "new.pcd", names[1])

    @unittest.expectedFailure  # flat faces slide on each other: a scan of the chair is 0.2 off
    def test_merged_scans_stand_where_they_were(self):
        names, places = self.turntable(self.chair, (1, (0.3, -1)), (3, (1, 0.6)), (5, (-0.8, 0.9)))
        found = self.report(*names, "-merge all.ply")
        for scan, place in zip(found["scans"], places):
            error = np.linalg.solve(places[0], np.reshape(scan["transform"], (4, 4)) @ place)
            error = min((error, error @ np.diag([-1, -1, 1, 1])), key=lambda each: abs(each - np.eye(4)).max())
            self.assertLess(abs(error - np.eye(4)).max(), 0.05)

    def test_says_that_nothing_fits(self):
        scan, _ = self.scan()
        self.fails(1, "does not fit", scan, "never.pcd -quiet -target box.off -json report.json")
        self.assertEqual((self.error.count("\n"), '"converged": false' in self.text("report.json")), (1, True), self.error)
        self.assertIn("of the source lie on the target", self.error)
        self.assertFalse((self.folder / "never.pcd").exists())

    def hidden(self, points, model, viewpoint):
        """How many reflections of the points, in the plane of the chair, its scanner cannot see."""
        eye, *points = np.linalg.solve(model, np.vstack([np.vstack([viewpoint, points]).T, np.ones(len(points) + 1)]))[:3].T
        rays = np.array(points) * (-1, 1, 1) - eye
        return (np.min([block(*part)(eye, rays) for part in (SEAT, BACK)], axis=0) < 0.99).sum()

    def test_completes_a_scan_and_marks_what_it_adds(self):
        scan, model = self.scan()
        self.run_tool(scan, "out.ply -complete -target chair.off -html o.html")
        self.assertIn('"the input and what completes it"', self.text("o.html"), "colors tell which is which")
        before, after = pcd_points(scan), self.points("out.ply")
        viewpoint = np.array(pcd_header(scan)["VIEWPOINT"][:3], float)
        hidden = self.hidden(xyz(before), model, viewpoint)
        self.assertGreater(hidden, 100, "a side of it was hidden")
        self.assertAlmostEqual(len(after) - len(before), hidden, delta=0.2 * hidden)
        np.testing.assert_array_equal(after["reflected_of"][:len(before)], -1)
        added = after["reflected_of"][len(before):]
        self.assertGreaterEqual(added.min(), 0)
        np.testing.assert_array_equal(after["label"][len(before):], added)
        self.assert_reflected(after, len(before))

    def test_leaves_out_what_is_no_point(self):
        """But rows and columns stay, also in a PLY file, where the element camera has their numbers."""
        scan, _ = self.scan()
        finite, every = len(pcd_points(scan)), len(ply_points(self.folder / "seen.ply")[0])
        self.assertLess(finite, every)
        added = self.report("seen.ply", "both.pcd -complete")["completed"]["num_added"]
        self.assertIn(f": {finite + added} points]", self.error)
        points = pcd_points(self.folder / "both.pcd")
        self.assertTrue(np.isfinite(xyz(points)).all())
        np.testing.assert_array_equal(points["reflected_of"] < 0, np.arange(finite + added) < finite)
        self.assert_reflected(points, finite)
        for name in ("kept.pcd", "kept.ply"):
            self.run_tool("seen.ply", name)
            self.assertIn(f"Saving {name} [done", self.error)
            self.assertIn(f": {finite} points]\n", self.error.split("Saving")[1])
        self.assertEqual([len(pcd_points(self.folder / "kept.pcd")), len(self.points("kept.ply"))], [every, every])

    def test_completes_nothing_that_has_no_symmetry_unless_told_to(self):
        report = self.report(self.scan()[0], "out.ply -complete")["completed"]
        self.assertIn(report["kind"], ("symmetry", "possible"))
        self.assertGreater(report["confidence"], 0.2)
        self.assertEqual(report["num_added"], (self.points("out.ply")["reflected_of"] >= 0).sum())
        self.run_tool(self.write("t.off", TETRAHEDRON), "-points 6000 -support t.pcd", tool="planes")
        cloud = "t.pcd"
        self.fails(1, "has no plane of symmetry to complete it across; -any_plane", cloud, "t.ply -complete -quiet")
        self.assertFalse((self.folder / "t.ply").exists())
        forced = self.report(cloud, "t.ply -complete -any_plane")["completed"]
        self.assertEqual(forced["kind"], "approximate")
        self.assertLess(forced["confidence"], 0.2)
        for flags in ("-complete", "-symmetrize mean", "t.ply -any_plane"):
            self.run_tool(cloud, flags, code=2)
        self.run_tool(cloud, "s.ply -symmetrise mean -quiet")  # the former spelling

    def test_makes_a_mesh_symmetric(self):
        """A box whose right end stands 0.02 further out than its left one, about x = 0.01."""
        corners = box_corners(2, 1.5, 1)
        corners[[1, 5], 0] = 2.02
        mesh = self.write("m.off", off(corners, BOX_FACES))
        self.write("l.txt", "# ends\n-2 0 0, 2 0 0\n0 1.5 0\n")
        found = self.report(mesh, "s.ply -symmetrize mean -landmarks l.txt")["symmetrized"]
        self.assertLess(found["deviation"], 1e-5 * 5)
        self.assertLess(found["greatest_asymmetry"], 0.025)
        self.assertEqual([len(found["landmarks"][key]) for key in ("paired", "midline")], [1, 1])
        self.assertIn("from its own reflection, exact with -cut\nlandmarks: object asymmetry", self.output)
        header, vertices, _ = ply_text(self.text("s.ply"))
        self.assertIn("element face 6\n", header)
        self.assertIn("property float asymmetry\n", header)
        self.assertTrue(np.isfinite(vertices[3, 3]))
        self.run_tool(mesh, "c.ply -symmetrize mean -cut")
        self.run_tool(self.write("even.off", off(box_corners(2, 1.5, 1), BOX_FACES)), "-symmetrize mean -html c.html")
        self.assertIn("no asymmetry beyond the rounding of coordinates", self.text("c.html"))
        self.assertIn("element face 28\n", self.text("c.ply"), "two triangles of an end, twelve of four sides")
        self.fails(2, ".ply", mesh, "s.pcd -symmetrize mean")
        self.write("bad.txt", "1 2 3\n1 2\n")
        self.fails(1, "bad.txt: line 2", mesh, "-symmetrize mean -landmarks bad.txt")
        self.run_tool(mesh, "-complete -symmetrize mean", code=2)

    def test_writes_what_is_symmetric_about_its_own_frame(self):
        """Chairs that lean to one side: none has a symmetry, and the plane of the frame is not the best one."""
        for lean in (0.1, 0.3):
            corners, faces = boxes(SEAT, BACK)
            corners[:, 0] += lean * corners[:, 2] * (corners[:, 1] > 0.5) + lean * corners[:, 1] ** 2
            mesh = self.write("lean.off", off(corners, faces))
            for flags in ("-symmetrize mean", "-symmetrize left -cut"):
                found = self.report(mesh, "c.ply -seed 3 " + flags)
                points = ply_text(self.text("c.ply"))[1][:, :3]
                reflected = points * (-1, 1, 1)
                if "-cut" in flags:  # without, vertices have no partners
                    apart = np.linalg.norm(points[:, None] - reflected, axis=2).min(axis=1)
                    self.assertLess(apart.max(), 1e-5, (lean, flags))
                self.assertLess(abs(points[:, 0].max() + points[:, 0].min()), 1e-4 + 2 * found["symmetrized"]["deviation"], (lean, flags))
                transform = np.reshape(found["transform"], (4, 4))
                plane = np.array(found["symmetrized"]["plane"])
                np.testing.assert_allclose(abs(transform[0] @ np.r_[plane[:3], 0]), 1, atol=1e-6)
                np.testing.assert_allclose(found["axes"][0], transform[0, :3], atol=1e-6)

    def test_makes_a_cloud_symmetric(self):
        scan, _ = self.scan()
        self.run_tool(scan, "out.ply -symmetrize left -target chair.off")
        points = self.points("out.ply")
        half = len(points) // 2
        np.testing.assert_array_equal(points["reflected_of"][half:], np.arange(half))
        self.assert_reflected(points, half)
