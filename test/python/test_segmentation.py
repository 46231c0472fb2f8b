"""Measures of segmentations on a box whose labels are known."""
import unittest

from needed import need

need("open3d", "scipy", "pcl_symmetry")
import numpy as np

import bench
import segmentation


class Measures(unittest.TestCase):
    def setUp(self):
        vertices = [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
        quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
        self.mesh = bench.make_mesh(vertices, quads)
        self.surface = segmentation.Surface(self.mesh)
        self.of = lambda *faces: segmentation.Segmentation(self.surface, np.array(faces)[self.mesh.polygons])

    def test_equal_segmentations_are_at_distance_0(self):
        found = segmentation.compare(self.surface, self.of(0, 0, 1, 1, 2, 2), self.of(5, 5, 3, 3, 4, 4))
        np.testing.assert_allclose(list(found.values()), 0, atol=1e-12)

    def test_rand_distance_counts_pairs(self):
        # 12 triangles, 66 pairs: 4 + 4 + 4 apart from one segment of 12: 66 - 3 * 6 = 48 pairs are told apart
        found = segmentation.compare(self.surface, self.of(0, 0, 1, 1, 2, 2), self.of(0, 0, 0, 0, 0, 0))
        self.assertAlmostEqual(found["rand"], 48 / 66)
        self.assertAlmostEqual(found["hamming"], 1 / 3)  # nothing is missing, two thirds are false
        self.assertTrue(np.isnan(found["cut"]))

    def test_cuts_are_as_far_apart_as_they_lie(self):
        # the borders of the faces x = 0 and x = 1 are one edge apart everywhere, there and back
        found = segmentation.compare(self.surface, self.of(1, 0, 0, 0, 0, 0), self.of(0, 1, 0, 0, 0, 0))
        self.assertAlmostEqual(found["cut"], 2 / self.surface.mean_radius)

    def test_labels_that_a_plane_swaps_agree_across_it(self):
        halves = np.array([0, 1, 2, 2, 2, 2])[self.mesh.polygons]
        self.assertAlmostEqual(segmentation.mirror_agreement(self.surface, halves, [1, 0, 0, -0.5]), 1)
        self.assertLess(segmentation.mirror_agreement(self.surface, halves, [0.6, 0.8, 0, -0.7]), 0.9)

    def test_bad_labels_get_a_sentence(self):
        with self.assertRaisesRegex(bench.BadInput, "no_file.seg: is no list of labels"):
            segmentation.read_labels("no_file.seg", self.mesh)


if __name__ == "__main__":
    unittest.main()
