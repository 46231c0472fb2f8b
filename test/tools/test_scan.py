"""The virtual scanner as a tool."""
import unittest

import tool_run
from tool_run import ToolTest, np


class Scan(ToolTest):
    tool = "scan"

    def setUp(self):
        super().setUp()
        self.mesh = self.write("box.off", tool_run.box(1.0))

    def seen(self, name, transform=np.eye(4)):
        """The finite points of a scan in the frame of the model."""
        points = tool_run.xyz(tool_run.ply_points(self.folder / name)[0])
        points = points[np.isfinite(points).all(axis=1)]
        return np.linalg.solve(transform, np.vstack([points.T, np.ones(len(points))]))[:3].T

    def assert_on_box(self, points):
        np.testing.assert_allclose((abs(points) / (1, 1, 2)).max(axis=1), 1, atol=1e-5)

    def test_writes_one_organized_scan_with_its_viewpoint(self):
        for name in ("a.pcd", "a.ply"):
            report = self.report(self.mesh, name, "-direction -1,-2,0.5")
        scan, = report["scans"]
        header = tool_run.pcd_header(self.folder / "a.pcd")
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


if __name__ == "__main__":
    unittest.main()
