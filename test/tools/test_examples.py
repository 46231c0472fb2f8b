"""The examples, run on a scan of a box, on a whole box, and on the box on a table."""
import os
import subprocess
from pathlib import Path

from tool_run import BOX_FACES, ToolTest, box_corners, box_off, off

EXAMPLES = Path(os.environ["TOOLS"]) / "examples"
# Arguments, what is printed at least once, what is printed so many times, and what the output file holds.
CASES = (("01_first_plane scan.pcd", ["a b c d = ", "reflects to"], {"nan": 0}, ""),
         ("02_options box.pcd", ["262144 planes", ": odds x "], {"symmetry ": 3}, ""),
         ("03_visibility scan.pcd", ["seen from one side", "have a counterpart"], {}, ""),
         ("04_alignment scan.pcd", ["center of symmetry"], {"axis": 3, "nan": 0}, ""),
         ("05_registration scan.pcd box.pcd", ["confidence"], {}, ""),
         ("06_matching models scan.pcd box.pcd", ["PRST ", "model_1 distance", "model_1 confidence "], {}, ""),
         ("07_segmentation box.pcd out.pcd", ["part 0: "], {}, "FIELDS x y z label"),
         ("08_own_search_and_point_type box.pcd", [], {"confidence": 3}, ""),
         # The box of D2 turns by 0.1 radians a frame.
         ("09_symmetric_poses box.pcd", ["group D2", "look 28.6"], {"the track by 5.7": 5}, ""),
         ("10_scene scene.pcd out.pcd", ["1 supporting planes", "  plane "], {"object of ": 1}, "FIELDS x y z"),
         ("11_completion scan.pcd out.pcd", [" points added to "], {}, "FIELDS x y z"),
         ("12_viewpoint box.pcd", ["seen from ", "worst "], {}, ""),
         ("15_turntable scan.pcd other.pcd out.pcd", [" points, "], {"left out": 0}, "FIELDS x y z"))


class Examples(ToolTest):
    def test_print_what_they_find(self):
        mesh = self.write("box.off", box_off(1.4))
        table = [(-6, -6, -2), (6, -6, -2), (6, 6, -2), (-6, 6, -2)]
        scene = off([*box_corners(1, 1.4, 2), *table], [*BOX_FACES, (8, 9, 10, 11)])
        self.run_tool(mesh, "scan.pcd -quiet", tool="scan")
        self.run_tool(mesh, "other.pcd -direction 1,-1,0.8 -quiet", tool="scan")
        self.run_tool(self.write("scene.off", scene), "scene.pcd -direction 1,1.5,1 -quiet", tool="scan")
        self.run_tool(mesh, "-support box.pcd -quiet", tool="planes")
        for arguments, printed, counted, written in CASES:
            name, *words = arguments.split()
            with self.subTest(name):
                done = subprocess.run([EXAMPLES / name, *words], capture_output=True, cwd=self.folder, text=True, check=False)
                self.assertEqual(done.returncode, 0, done.stderr)
                for part in printed:
                    self.assertIn(part, done.stdout)
                self.assertEqual({part: done.stdout.count(part) for part in counted}, counted)
                if written:
                    self.assertIn(written, self.text("out.pcd"))
