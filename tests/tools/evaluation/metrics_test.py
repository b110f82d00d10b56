"""What the metrics of tools/evaluation give for motions of which the answer is known."""
import pathlib
import sys
import unittest

try:
    import numpy as np
except ImportError:
    print("skipped: this python3 has no NumPy")
    sys.exit(77)

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "tools"))
from evaluation import geometry, metrics, report  # noqa: E402  (the path comes first)


class Correlations(unittest.TestCase):
    def test_one_for_a_scaled_copy_and_minus_one_for_its_mirror(self):
        truth = np.array([[0.0, 0.0], [1.0, 1.0], [0.5, 0.5]])
        np.testing.assert_allclose(metrics.correlations(truth * [3, -2] + 1, truth), [1, -1])

    def test_zero_when_ours_does_not_move(self):
        truth = np.array([[0.0], [1.0]])
        np.testing.assert_array_equal(metrics.correlations(np.zeros((2, 1)), truth), [0])


class Errors(unittest.TestCase):
    def test_mean_absolute_error_is_by_column(self):
        np.testing.assert_allclose(metrics.absolute_errors(np.array([[1.0, 0], [0, 0]]), np.zeros((2, 2))), [0.5, 0])

    def test_motion_error_is_the_error_over_the_motion(self):
        truth = np.array([[[0.0, 0, 2]], [[0, 0, 4]]])
        self.assertAlmostEqual(metrics.motion_error(np.zeros_like(truth), truth), 1)
        self.assertAlmostEqual(metrics.motion_error(truth * 0.9, truth), 0.1)


class Series(unittest.TestCase):
    def test_a_shape_is_active_when_it_exceeds_the_threshold_once(self):
        self.assertEqual(list(metrics.active(np.array([[0.0, 0.2], [0.3, 0.25]]))), [True, False])

    def test_a_frame_without_a_face_holds_the_one_before(self):
        held = metrics.hold(np.array([[np.nan], [0.4], [np.nan], [0.1]]))
        np.testing.assert_array_equal(held[:, 0], [0, 0.4, 0.4, 0.1])

    def test_a_blink_is_one_apex_for_each_closing(self):
        opening = np.full(100, 0.3)
        opening[20:25] = [0.2, 0.1, 0.05, 0.1, 0.2]
        opening[60:62] = [0.15, 0.12]
        self.assertEqual(metrics.blinks(opening, 36), [22, 61])

    def test_slow_narrowing_is_no_blink(self):
        self.assertEqual(metrics.blinks(np.linspace(0.3, 0.1, 400), 36), [])

    def test_aligning_takes_out_moving_turning_and_scaling(self):
        face = np.array([[0.0, 0], [4, 0], [4, 3], [0, 3], [2, 1]])
        turn = np.array([[0.6, -0.8], [0.8, 0.6]])
        moved = 1.7 * face @ turn.T + [5, -3]
        np.testing.assert_allclose(metrics.align(moved[None], face, [0, 1, 2, 3])[0], face, atol=1e-12)


class Warps(unittest.TestCase):
    def test_the_mouth_is_half_again_as_wide_and_the_brows_stay(self):
        neutral = np.zeros((68, 3))
        neutral[48:60, 0] = np.linspace(-2, 2, 12)
        neutral[17:27, 1] = 8
        warped = geometry.wide_mouth(neutral, neutral)
        near_middle = 53
        self.assertAlmostEqual(warped[near_middle, 0] / neutral[near_middle, 0], 1.5, delta=0.01)
        np.testing.assert_allclose(warped[17:27], neutral[17:27], atol=1e-3)


class Reports(unittest.TestCase):
    def test_a_figure_at_its_limit_is_met_and_one_that_is_no_number_is_not(self):
        self.assertTrue(report.Row("a", 0.05, ("<=", 0.05)).met)
        self.assertFalse(report.Row("a", 0.051, ("<=", 0.05)).met)
        self.assertFalse(report.Row("a", float("nan"), (">=", 0)).met)
        self.assertTrue(report.Row("only shown", 7).met)

    def test_what_is_left_out_is_not_met_and_is_named(self):
        section = report.Section("Video", left_out=["there is no video.mp4 in the data folder"])
        self.assertFalse(section.met)
        self.assertIn("left out: Video: there is no video.mp4", report.summary([section]))

    def test_tables_are_aligned_markdown(self):
        self.assertEqual(report.table([["a", "bb"], ["ccc", ""]]), "| a   | bb |\n|-----|----|\n| ccc |    |")


if __name__ == "__main__":
    unittest.main()
