"""The virtual scanner as a tool."""
from tool_run import BOX_FACES, ToolTest, box_corners, box_off, np, off, pcd_header, ply_points, rotation, xyz


class Scan(ToolTest):
    tool = "scan"
    files = dict(mesh=("box.off", box_off(1.0)))

    def seen(self, name, transform=np.eye(4)):
        """The finite points of a scan in the frame of the model."""
        points = xyz(ply_points(self.folder / name)[0])
        points = points[np.isfinite(points).all(axis=1)]
        return np.linalg.solve(transform, np.vstack([points.T, np.ones(len(points))]))[:3].T

    def assert_on_box(self, points):
        np.testing.assert_allclose((abs(points) / (1, 1, 2)).max(axis=1), 1, atol=1e-5)

    def test_writes_one_organized_scan_with_its_viewpoint(self):
        for name in ("a.pcd", "a.ply"):
            report = self.report(self.mesh, name, "-direction -1,-2,0.5")
        scan, = report["scans"]
        header = pcd_header(self.folder / "a.pcd")
        self.assertEqual([header["WIDTH"], header["HEIGHT"]], [[str(scan["width"])], [str(scan["height"])]])
        self.assertGreater(scan["height"], 1)
        points = self.seen("a.ply")
        self.assert_on_box(points)
        self.assertEqual(len(points), scan["num_points"])
        self.assertAlmostEqual(len(points), 10000, delta=500)
        expected = 2 * np.sqrt(24) * np.array([-1, -2, 0.5]) / np.linalg.norm([-1, -2, 0.5])
        np.testing.assert_allclose(scan["viewpoint"], expected, atol=1e-9)
        np.testing.assert_allclose(np.array(header["VIEWPOINT"][:3], float), expected, atol=1e-4)
        np.testing.assert_array_equal(scan["transform"], np.eye(4).ravel())
        self.assertGreaterEqual(min(report["timing_ms"][step] for step in ("load", "scan", "save")), 0)
        self.assertIn("[done, ", self.error)

    def test_writes_eight_scans_in_one_random_pose(self):
        scans = self.report(self.mesh, "b.ply -all -random_pose -seed 3 -quiet -points 2000")["scans"]
        self.assertEqual(self.output + self.error, "")
        self.assertEqual([scan["file"] for scan in scans], [f"b_{i}.ply" for i in range(8)])
        for scan in scans:
            self.assertEqual(scan["transform"], scans[0]["transform"])
            self.assert_on_box(self.seen(scan["file"], np.reshape(scan["transform"], (4, 4))))


class BoxScan(ToolTest):
    """A box whose center is not the origin, from the corners of a cube around it."""
    tool = "scan"
    half, center = np.array([0.5, 0.8, 1.2]), np.array([10.0, -20.0, 5.0])
    corners = np.array([[1 if i >> k & 1 else -1 for k in range(3)] for i in range(8)]) / np.sqrt(3)
    diagonal = 2 * np.linalg.norm(half)
    files = dict(mesh=("box.off", off(center + box_corners(*half), BOX_FACES)))

    def scanned(self, *arguments, name="a.ply"):
        """What is reported of a scan, and its points, one a pixel."""
        scan, = self.report(self.mesh, name, *arguments)["scans"]
        return scan, xyz(ply_points(self.folder / name)[0]).astype(float)

    def test_every_pixel_sees_the_first_surface_on_its_ray(self):
        for scan in self.report(self.mesh, "a.ply -all -fov 22.918311805232928")["scans"]:
            points = xyz(ply_points(self.folder / scan["file"])[0]).astype(float)
            n = scan["width"]
            self.assertEqual(scan["height"], n)
            row, column = np.divmod(np.arange(n * n), n)
            pose = np.reshape(scan["sensor_pose"], (4, 4))
            rays = np.stack([2 * (column + 0.5) / n - 1, 2 * (row + 0.5) / n - 1, np.full(n * n, 1 / np.tan(0.2))]).T @ pose[:3, :3].T
            sides = (np.stack([self.center - self.half, self.center + self.half])[:, None] - pose[:3, 3]) / rays
            entry, exit = sides.min(axis=0).max(axis=1), sides.max(axis=0).min(axis=1)
            hit = entry <= exit
            np.testing.assert_array_equal(np.isfinite(points).all(axis=1), hit)
            away = np.linalg.norm(points - (pose[:3, 3] + entry[:, None] * rays), axis=1)[hit]
            self.assertLess(away.max(), 4e-6)  # float has 2e-6 at 20
            self.assertEqual(hit.sum(), scan["num_points"])

    def test_stands_at_two_diagonals_and_looks_at_the_center(self):
        scans = self.report(self.mesh, "a.pcd -all -points 1000")["scans"]
        self.assertEqual(len(scans), 8)
        for corner, scan in zip(self.corners, scans):
            pose = np.reshape(scan["sensor_pose"], (4, 4))
            expected = self.center + 2 * self.diagonal * corner
            np.testing.assert_allclose(pose[:3, 3], expected, atol=1e-6)
            np.testing.assert_allclose(pose[:3, 2], -corner, atol=1e-6)  # z looks forward
            self.assertLess(pose[2, 1], 0)  # y looks down
            self.assertAlmostEqual(np.linalg.det(pose[:3, :3]), 1, delta=1e-5)
            x, y, z, w, i, j, k = map(float, pcd_header(self.folder / scan["file"])["VIEWPOINT"])
            np.testing.assert_allclose([x, y, z], expected, atol=1e-4)
            angle = 2 * np.arctan2(np.linalg.norm([i, j, k]), w)
            np.testing.assert_allclose(rotation(np.array([i, j, k]), angle), pose[:3, :3], atol=1e-5)

    def test_same_bytes_for_any_number_of_threads(self):
        def scanned(arguments):
            self.run_tool(self.mesh, "a.ply -noise 0.01 -random_pose", arguments)
            return (self.folder / "a.ply").read_bytes()

        one = scanned("-threads 1")
        self.assertEqual(scanned("-threads 2"), one)
        self.assertEqual(scanned("-threads 8"), one)
        self.assertNotEqual(scanned("-seed 2"), one)

    def test_noise_moves_points_along_their_rays(self):
        scan, clean = self.scanned("-corner 7")
        _, noisy = self.scanned("-corner 7 -noise 0.01")
        hit = np.isfinite(clean).all(axis=1)
        rays = clean[hit] - np.reshape(scan["sensor_pose"], (4, 4))[:3, 3]
        rays /= np.linalg.norm(rays, axis=1, keepdims=True)
        moved = noisy[hit] - clean[hit]
        along = (rays * moved).sum(axis=1)
        self.assertLess(np.linalg.norm(moved - along[:, None] * rays, axis=1).max(), 1e-5)
        sigma, n = 0.01 * self.diagonal, scan["num_points"]
        self.assertLess(abs(along.sum() / n), 4 * sigma / np.sqrt(n))  # four standard errors
        self.assertAlmostEqual(np.sqrt((along ** 2).sum() / n), sigma, delta=4 * sigma / np.sqrt(2 * n))
        self.run_tool(self.mesh, "b.ply -all -noise 0.01")
        others = xyz(ply_points(self.folder / "b_7.ply")[0])
        self.assertFalse(np.array_equal(others[hit], noisy[hit]), "scans from eight corners have noise of their own")

    def test_works_at_any_scale(self):
        for scale in 1e-9, 1e9:
            mesh = self.write("scaled.off", off(scale * box_corners(*self.half), BOX_FACES))
            scan, = self.report(mesh, "a.ply")["scans"]
            self.assertAlmostEqual(scan["num_points"], 10000, delta=500)

    def test_random_poses_are_uniform(self):
        """The mean of uniformly distributed rotation matrices is zero; each entry has variance 1/3."""
        poses = []
        for seed in range(30):
            scan, = self.report(self.mesh, f"a.pcd -random_pose -points 10 -quiet -seed {seed}")["scans"]
            poses.append(np.reshape(scan["transform"], (4, 4)))
            np.testing.assert_allclose(poses[-1][:3, :3] @ poses[-1][:3, :3].T, np.eye(3), atol=1e-12)
        self.assertLess(abs(np.mean(poses, axis=0)[:3, :3]).max(), 5 * np.sqrt(1 / 3 / len(poses)))

    def test_refuses_what_it_cannot_scan(self):
        flat = "OFF\n3 1 0\n1 2 3\n1 2 3\n1 2 3\n3 0 1 2\n"
        for name, content in (("points.off", "OFF\n1 0 0\n1 2 3\n"), ("flat.off", flat), ("nan.off", flat.replace("3\n3", "nan\n3"))):
            self.fails(1, name, self.write(name, content), "never.pcd")
        self.assertFalse((self.folder / "never.pcd").exists())

    def test_says_when_the_model_reaches_beyond_the_picture(self):
        self.mesh = self.write("cube.off", box_off(1.0, 1.0))
        # 0.47 diagonals from the axis, a picture of 22.9 degrees shows 0.41.
        for arguments, cropped in ("-corner 7 -fov 22.9", True), ("-corner 7", False), ("-corner 7 -fov 34.4", False):
            self.assertEqual(self.scanned(arguments)[0]["cropped"], cropped)
            self.assertEqual("reaches beyond the picture" in self.error, cropped)
