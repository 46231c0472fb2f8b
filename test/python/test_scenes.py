"""Scenes whose pictures are known, and how answers are matched with their objects."""
import unittest

from needed import need

need("open3d", "scipy", "pcl_symmetry")
import numpy as np

import bench
import scenes

NOTHING = {"planes": [], "axes": [], "centers": [], "center": [0, 0, 0], "diagonal": 1.0}


class Judging(unittest.TestCase):
    def test_objects_match_by_the_share_of_common_points(self):
        found, truth = np.array([0, 0, 0, 1, -1, 1]), np.array([1, 1, -1, 0, 0, 0])
        np.testing.assert_allclose(scenes.overlaps(found, truth, (2, 2)), [[0, 2 / 3], [2 / 3, 0]])

    def test_poses_count_symmetries(self):
        half_turn, quarter = np.diag([-1.0, -1, 1, 1]), np.eye(4)
        quarter[:2, :2] = [[0, -1], [1, 0]]
        planes = [{"coefficients": [1, 0, 0, 0]}, {"coefficients": [0, 1, 0, 0]}]
        self.assertAlmostEqual(scenes.farthest_off(half_turn, NOTHING), 1)
        self.assertAlmostEqual(scenes.farthest_off(half_turn, {**NOTHING, "planes": planes}), 0)
        self.assertAlmostEqual(scenes.farthest_off(quarter, {**NOTHING, "planes": planes}), np.sqrt(0.5))
        round_ = {**NOTHING, "axes": [{"point": [0, 0, 3], "direction": [0, 0, 1]}]}
        self.assertAlmostEqual(scenes.farthest_off(quarter, round_), 0)

    def test_bands_of_occlusion(self):
        self.assertEqual([scenes.band_of(x) for x in (0, 0.1, 0.69, 0.7)], [0, 1, 3, None])


class Pictures(unittest.TestCase):
    def test_a_camera_sees_a_square_where_it_is(self):
        square = np.array([(-0.1, -0.1, 2), (0.1, -0.1, 2), (0.1, 0.1, 2), (-0.1, 0.1, 2)])[[[0, 1, 2], [0, 2, 3]]]
        depths = scenes.depths_of(square)
        hit = np.isfinite(depths)
        np.testing.assert_allclose(depths[hit], 2, atol=1e-9)
        self.assertLess(np.abs(scenes.rays()[hit, :2]).max(), 0.05)
        self.assertLess(abs(hit.sum() / 53**2 - 1), 0.1)  # 105 / 2 pixels

    def test_disparities_come_in_steps(self):
        noisy = scenes.with_noise(np.full((20, 20), 1.3), 1.0, bench.generator(1))
        steps = 1 / (scenes.STEP * noisy)
        np.testing.assert_allclose(steps, np.round(steps), atol=1e-6)
        self.assertGreater(noisy.std(), 0)


if __name__ == "__main__":
    unittest.main()
