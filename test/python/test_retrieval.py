"""Measures of rankings that are known, and rotations of descriptors."""
import unittest

from needed import need

need("open3d", "scipy", "pcl_symmetry")
import pcl_symmetry
import numpy as np

import retrieval


class Rankings(unittest.TestCase):
    def test_measures_of_a_known_ranking(self):
        found = retrieval.scores(np.array([1, 4, 5]))
        self.assertEqual(found["nearest"], 1)
        self.assertAlmostEqual(found["tier1"], 1 / 3)  # among the first 3
        self.assertAlmostEqual(found["tier2"], 1)  # among the first 6
        self.assertAlmostEqual(found["e"], 2 * 3 / (32 + 3))
        best = 1 + 1 + 1 / np.log2(3)
        self.assertAlmostEqual(found["dcg"], (1 + 1 / 2 + 1 / np.log2(5)) / best)
        np.testing.assert_allclose(found["precision"][[0, 6, 19]], [1, 2 / 4, 3 / 5])  # recalls 0.05, 0.35 and 1

    def test_ranks_leave_the_query_out_and_equal_distances_go_by_index(self):
        distances = np.zeros((4, 4))
        ranks = retrieval.relevant_ranks(distances, np.array(["a", "b", "a", "a"]), 2)
        np.testing.assert_array_equal(ranks, [1, 3])

    def test_a_model_alone_in_its_class_is_no_query(self):
        judged = retrieval.judge(np.array([[0, 1, 2], [1, 0, 3], [2, 3, 0.0]]), np.array(["a", "a", "b"]))
        self.assertEqual(list(judged["class"]), ["a", "a"])
        self.assertEqual(judged["nearest"].mean(), 1)

    def test_distances_of_all_pairs_are_those_of_the_library(self):
        roots = np.random.default_rng(1).uniform(size=(3, 8, 6, 4))
        for weights, of_planes in ((retrieval.plane_weights(roots.shape[1:]), True), (1, False)):
            expected = [[pcl_symmetry.descriptor_distance(a, b, of_planes=of_planes) for b in roots] for a in roots]
            np.testing.assert_allclose(retrieval.l2(weights * roots), expected, atol=0.01)  # roots of rounding errors


class Rotations(unittest.TestCase):
    def test_descriptors_rotate_with_the_points(self):
        points = np.random.default_rng(1).normal(size=(300, 3)) * [0.5, 0.3, 0.15]
        for order, signs in retrieval.ROTATIONS[::5]:
            turned = points[:, list(order)] * signs
            expected = retrieval.gedt(turned, 12)
            np.testing.assert_allclose(retrieval.rotated_cubes(retrieval.gedt(points, 12), order, signs), expected, atol=1e-9)

    def test_all_turns_find_a_turned_copy(self):
        cubes = retrieval.unit(np.random.default_rng(1).uniform(size=(3, 2, 6, 6, 6)))
        copy = retrieval.rotated_cubes(cubes[:1], *retrieval.ROTATIONS[7])
        distances = retrieval.least_distances((np.concatenate([cubes, copy]), retrieval.rotated_cubes, retrieval.unit))
        self.assertLess(distances[0, 3], 1e-3)
        self.assertGreater(distances[0, 1], 0.1)

    def test_planes_rotate_with_their_normals(self):
        maps = np.zeros((1, 8, 16, 4))
        maps[0, 7, 0, 3] = 1  # nearly x, at the greatest r
        order, signs = next(r for r in retrieval.ROTATIONS if r[0] == (1, 2, 0) and tuple(r[1]) == (1, 1, 1))  # x becomes z
        turned = retrieval.rotated_planes(maps, order, signs)
        self.assertGreater(turned[0, 0, :, 3].max(), 0)  # theta is near 0
        self.assertEqual(turned[0, 3:].max(), 0)


if __name__ == "__main__":
    unittest.main()
