"""The Python module: same bytes as roevo-odometry, arrays of all kinds, bad ones, maps."""
import os
import pathlib
import subprocess
import sys
import unittest

import numpy as np
from PIL import Image

import roevo
from simulated import OPTIONS, folder, read_list, recording, run, track, tum_text


class SameAsTheProgram(unittest.TestCase):
    def test_trajectories_map_and_covariances_have_the_programs_bytes(self):
        odometry, results = track()
        odometry.refine_all()
        self.assertEqual([result.status for result in results], ["initialised"] + 15 * ["ok"])
        self.assertEqual(tum_text(odometry.trajectory()), (recording.out / "trajectory.txt").read_text())
        self.assertEqual(tum_text(odometry.live_trajectory()), (recording.out / "trajectory_live.txt").read_text())
        keyframes = odometry.save_map(folder / "ours.map")
        self.assertGreater(keyframes, 2)
        self.assertEqual(keyframes, len(odometry.keyframes()))
        self.assertEqual((folder / "ours.map").read_bytes(), (folder / "room.map").read_bytes())
        written = np.loadtxt(folder / "covariances.txt")[:, 1:].reshape(-1, 6, 6)
        np.testing.assert_allclose([result.covariance for result in results], written, rtol=1e-5, atol=1e-15)

    def test_results_agree_with_the_trajectory(self):
        odometry, results = track()
        for index, (result, row) in enumerate(zip(results, odometry.live_trajectory())):
            self.assertEqual((result.index, result.timestamp), (index, row[0]))
            np.testing.assert_array_equal(result.pose[:3, 3], row[1:4])
            np.testing.assert_array_equal(result.pose[3], [0, 0, 0, 1])
            x, y, z, w = row[4:]
            np.testing.assert_allclose(result.pose[0, :3], [1 - 2 * (y * y + z * z), 2 * (x * y - z * w),
                                                            2 * (x * z + y * w)], atol=1e-12)
            np.testing.assert_allclose(result.covariance, result.covariance.T, rtol=1e-12, atol=1e-18)
            self.assertTrue((np.linalg.eigvalsh(result.covariance) >= -1e-15).all())

    def test_motions_are_said_to_be_others_than_those_of_the_trajectory(self):
        odometry, _ = track()
        odometry.refine_all()
        poses = odometry.trajectory()[:, 1:4]
        moved = [np.linalg.norm(odometry.motion(k, k + 1)[:3, 3]) for k in range(15)]
        self.assertGreater(np.abs(moved - np.linalg.norm(np.diff(poses, axis=0), axis=1)).max(), 1e-6)
        self.assertIn("trajectory()", roevo.Odometry.motion.__doc__)
        self.assertIn("smoothed", roevo.Odometry.trajectory.__doc__)

    def test_motions_are_those_between_two_frames(self):
        odometry, results = track(odometry=roevo.Odometry(recording.camera, {**OPTIONS, "odometry.mode": "tr"}))
        poses = [result.pose for result in results]
        self.assertEqual(sum(result.map_correction for result in results), 0)  # so that live poses make motions
        np.testing.assert_allclose(odometry.motion(4, 9), np.linalg.inv(poses[4]) @ poses[9], atol=1e-12)
        covariance = odometry.motion_covariance(4, 9)
        np.testing.assert_allclose(covariance, covariance.T)
        self.assertTrue((np.linalg.eigvalsh(covariance) > 0).all())
        np.testing.assert_array_equal(odometry.motion_covariance(4, 4), np.zeros((6, 6)))
        for wrong in (odometry.motion, odometry.motion_covariance):
            for index in (16, -1, -5):  # the result of a frame that was rejected has -1
                with self.assertRaisesRegex(IndexError, f"no frame {index}: 16 frames have a pose"):
                    wrong(0, index)

class Example(unittest.TestCase):
    def test_a_folder_with_a_lens_and_depth_that_is_missing_has_the_programs_bytes(self):
        room, out = folder / "lens", folder / "lens_out"
        run("rawlog-simulate", "--scene", "livingroom", "--frames", 6, "--size", "320x240", "--layout", "tum",
            "--distortion", 0.1, 0.02, 0.001, 0.001, 0, "--output", room)
        depths = read_list(room / "depth.txt")[1:]
        (room / "depth.txt").write_text("".join(f"{stamp + 0.004:.6f} {name}\n" for stamp, name in depths))
        run("roevo-odometry", "--input", room, "--output", out, "--quiet")
        script = pathlib.Path(__file__).resolve().parents[2] / "examples" / "recording.py"
        made = subprocess.run([sys.executable, "-B", str(script), str(room)], check=True, text=True,
                              stdout=subprocess.PIPE)
        self.assertEqual(made.stdout, (out / "trajectory.txt").read_text())
        self.assertEqual(len(made.stdout.splitlines()), 1 + 5)
        (room / "camera.txt").unlink()
        refused = subprocess.run([sys.executable, "-B", str(script), str(room)], text=True, stderr=subprocess.PIPE)
        self.assertIn("camera.txt is missing", refused.stderr)
        self.assertEqual((refused.returncode, refused.stderr.count("\n")), (1, 1))


class Arrays(unittest.TestCase):
    def test_strides_order_of_colours_and_floats_change_nothing(self):
        expected = track()[0].trajectory()

        def backwards(array):  # the same values, with negative strides
            return array[::-1, ::-1].copy()[::-1, ::-1]

        def wide(array):  # one part of something larger
            around = np.zeros((array.shape[0] + 3, array.shape[1] + 5, *array.shape[2:]), array.dtype)
            around[1:-2, 2:-3] = array
            return around[1:-2, 2:-3]

        for convert in (backwards, wide, np.asfortranarray):
            self.assertFalse(convert(recording.frames[0][0]).flags.c_contiguous)
            np.testing.assert_array_equal(track(convert=convert)[0].trajectory(), expected)
        unit = np.float32(1) / np.float32(recording.depth_scale)
        bgr = [(rgb[..., ::-1], depth.astype(np.float32) * unit, stamp) for rgb, depth, stamp in recording.frames]
        np.testing.assert_array_equal(track(bgr, bgr=True)[0].trajectory(), expected)
        unknown = [(rgb, np.where(depth == 0, np.float32(np.nan), depth), stamp) for rgb, depth, stamp in bgr]
        np.testing.assert_array_equal(track(unknown, bgr=True)[0].trajectory(), expected)

    def test_arrays_may_be_reused_once_the_call_is_over(self):
        expected = track()[0].trajectory()
        odometry = roevo.Odometry(recording.camera, roevo.Options(OPTIONS))
        colour, depth = (np.empty_like(array) for array in recording.frames[0][:2])
        for rgb, units, stamp in recording.frames:
            colour[:], depth[:] = rgb, units
            odometry.process(colour, depth, stamp, depth_scale=recording.depth_scale)
            colour[:], depth[:] = 0, 0
        np.testing.assert_array_equal(odometry.trajectory(), expected)

    def test_grey_tracks(self):
        grey = [(np.asarray(Image.fromarray(rgb).convert("L")), depth, stamp) for rgb, depth, stamp in recording.frames]
        odometry, results = track(grey)
        self.assertEqual(results[-1].status, "ok")
        np.testing.assert_allclose(odometry.trajectory()[:, 1:4], track()[0].trajectory()[:, 1:4], atol=0.003)

    def test_a_mask_leaves_out(self):
        for kind in (bool, np.uint8):
            mask = np.ones((240, 320), kind)
            white, results = track(mask=mask, depth_scale=recording.depth_scale)
            np.testing.assert_array_equal(white.trajectory(), track()[0].trajectory())
            points = results[0].num_points
            mask[:, 100:] = 0
            self.assertLess(track(mask=mask, depth_scale=recording.depth_scale)[1][0].num_points, points / 2)

    def test_wrong_masks_are_refused_by_name(self):
        colour, depth, stamp = recording.frames[0]
        odometry = roevo.Odometry(recording.camera, roevo.Options(OPTIONS))
        for kind, message, mask in [
            (TypeError, "mask must be a numpy array, not str", "mask.png"),
            (TypeError, "mask is a masked array", np.ma.masked_array(np.ones((240, 320), bool))),
            (TypeError, "mask must be of type bool or uint8, not float64", np.ones((240, 320))),
            (ValueError, "mask must be height x width, not 240 x 320 x 1", np.ones((240, 320, 1), bool)),
            (ValueError, "mask is 320 x 240, but the camera has 240 rows", np.ones((320, 240), bool)),
        ]:
            with self.assertRaises(kind) as raised:
                odometry.process(colour, depth, stamp, depth_scale=5000, mask=mask)
            self.assertIn(message, str(raised.exception))

    def test_wrong_ones_are_refused_by_name_and_change_nothing(self):
        colour, depth, stamp = recording.frames[0]
        cases = [
            (TypeError, "colour must be a numpy array, not list", colour.tolist(), depth, 5000),
            (TypeError, "depth must be a numpy array, not NoneType", colour, None, 5000),
            (TypeError, "depth is a masked array: give depth.filled(0)", colour, np.ma.masked_greater(depth, 9000), 5000),
            (TypeError, "depth_scale must be a number, not str", colour, depth, "mm"),
            (TypeError, "colour must be of type uint8, not float64", colour / 255, depth, 5000),
            (TypeError, "colour must be of type uint8, not int8", colour.view(np.int8), depth, 5000),
            (TypeError, "depth must be of type uint16 or float32, not int32", colour, depth.astype(np.int32), 5000),
            (TypeError, "depth must be of type uint16 or float32, not >u2", colour, depth.astype(">u2"), 5000),
            (TypeError, "depth must be of type uint16 or float32, not float64", colour, depth / 5000, None),
            (ValueError, "colour must be height x width x 3 or height x width, not 240 x 320 x 4", colour[..., [0, 1, 2, 2]],
             depth, 5000),
            (ValueError, "colour must be height x width x 3 or height x width, not a single value", colour[0, 0, 0:1].sum(),
             depth, 5000),
            (ValueError, "colour is 320 x 240 x 3, but the camera has 240 rows and 320 columns",
             colour.transpose(1, 0, 2), depth, 5000),
            (ValueError, "depth is 120 x 320, but the camera has 240 rows and 320 columns", colour, depth[::2], 5000),
            (ValueError, "depth must be height x width, not 240 x 320 x 1", colour, depth[..., None], 5000),
            (ValueError, "depth is uint16: give depth_scale", colour, depth, None),
            (ValueError, "depth_scale must be above 0 units per metre, not 0.0", colour, depth, 0),
            (ValueError, "depth_scale must be above 0 units per metre, not nan", colour, depth, float("nan")),
            (ValueError, "depth_scale is for uint16 depth", colour, depth.astype(np.float32), 5000),
        ]
        odometry = roevo.Odometry(recording.camera, roevo.Options(OPTIONS))
        for kind, message, bad_colour, bad_depth, scale in cases:
            with self.subTest(message):
                if isinstance(bad_colour, np.generic):
                    bad_colour = np.array(bad_colour)
                with self.assertRaises(kind) as raised:
                    odometry.process(bad_colour, bad_depth, stamp, depth_scale=scale)
                self.assertIn(message, str(raised.exception))
                self.assertNotIn("\n", str(raised.exception))
        with self.assertRaisesRegex(TypeError, "^stamp must be a number, not NoneType$"):
            odometry.process(colour, depth, None, depth_scale=5000)
        self.assertEqual(odometry.trajectory().shape, (0, 8))
        track(odometry=odometry)
        np.testing.assert_array_equal(odometry.trajectory(), track()[0].trajectory())

    def test_depth_of_another_camera_is_registered(self):
        _, depth, _ = recording.frames[0]
        camera, scale = recording.camera, recording.depth_scale
        metres = depth.astype(np.float32) / np.float32(scale)
        same = roevo.register_depth(depth, camera, camera, np.eye(4), depth_scale=scale)
        np.testing.assert_allclose(same, metres, rtol=1e-5)
        back = np.eye(4)
        back[2, 3] = 0.5  # the colour camera is farther away
        far = roevo.register_depth(metres, camera, camera, back)
        self.assertAlmostEqual(far[120, 160], metres[118:123, 158:163].mean() + 0.5, delta=0.02)
        with self.assertRaisesRegex(ValueError, "T_colour_depth is no rigid motion"):
            roevo.register_depth(metres, camera, camera, 2 * np.eye(4))

    def test_bad_frames_are_rejected_with_a_reason(self):
        odometry, results = track(recording.frames[:3])
        colour, depth, stamp = recording.frames[2]
        for bad_stamp in (stamp, stamp - 1, float("nan")):
            result = odometry.process(colour, depth, bad_stamp, depth_scale=recording.depth_scale)
            self.assertEqual((result.status, result.pose, result.covariance), ("rejected", None, None))
            self.assertTrue(result.reason)
        self.assertEqual(len(odometry.trajectory()), 3)


class Maps(unittest.TestCase):
    def test_edges_keyframes_and_surface_are_arrays(self):
        odometry, _ = track()
        edges = odometry.map_edges()
        self.assertGreater(len(edges), 50)
        for edge in edges[:20]:
            self.assertEqual((edge.points.dtype, edge.colours.dtype), (np.float32, np.uint8))
            self.assertEqual(edge.points.shape, edge.colours.shape)
            self.assertEqual(edge.points.shape[1], 3)
            self.assertTrue(0 <= edge.confidence <= 1)
        points, colours = odometry.surface()
        self.assertEqual(points.shape, colours.shape)
        self.assertGreater(len(points), 1000)
        # All of it is before the camera that saw it, and no farther than depths are used
        first = odometry.keyframes()[0]
        seen = [edge.points for edge in odometry.keyframe_edges() if edge.keyframe == first.id]
        in_camera = (np.vstack(seen) - first.pose[:3, 3]) @ first.pose[:3, :3]
        self.assertTrue(((in_camera[:, 2] > 0.1) & (in_camera[:, 2] < 10)).all())

    def test_colours_are_rgb(self):
        red = [(np.dstack([rgb[..., 0], rgb[..., 1] // 4, rgb[..., 2] // 4]), depth, stamp)
               for rgb, depth, stamp in recording.frames[:2]]
        colours = track(red)[0].surface()[1].astype(float).mean(axis=0)
        self.assertGreater(colours[0], 2 * colours[2])

    def test_a_kept_map_is_recognised(self):
        odometry = roevo.Odometry(recording.camera)
        self.assertGreater(odometry.load_map(folder / "room.map", localise_only=True), 2)
        self.assertFalse(odometry.localised)
        _, results = track(odometry=odometry)
        self.assertTrue(odometry.localised)
        self.assertTrue(any(result.found_at >= 0 or result.joined_at >= 0 for result in results))
        truth = np.loadtxt(recording.out / "trajectory.txt")
        np.testing.assert_allclose(odometry.trajectory()[:, 1:4], truth[:, 1:4], atol=0.01)
        with self.assertRaisesRegex(RuntimeError, "only used to localise"):
            odometry.save_map(folder / "none.map")
        self.assertFalse((folder / "none.map").exists())

    def test_what_is_no_map_is_told_in_one_line(self):
        (folder / "text.map").write_text("not a map")
        with self.assertRaisesRegex(FileNotFoundError, "none.map"):
            roevo.Odometry(recording.camera).load_map(folder / "none.map")
        with self.assertRaisesRegex(RuntimeError, "text.map: ") as raised:
            roevo.Odometry(recording.camera).load_map(folder / "text.map")
        self.assertNotIn("\n", str(raised.exception))
        os.mkfifo(folder / "pipe")
        for read, kind in ((roevo.Odometry(recording.camera).load_map, RuntimeError), (roevo.Options.read, ValueError)):
            with self.assertRaisesRegex(kind, "pipe"):
                read(folder / "pipe")
        with self.assertRaisesRegex(RuntimeError, "keyframe"):
            roevo.Odometry(recording.camera).save_map(folder / "none.map")

    def test_files_that_cannot_be_read_or_written_are_as_for_open(self):
        odometry, options = track()[0], roevo.Options()
        os.mkfifo(folder / "fifo")
        for read in (roevo.Odometry(recording.camera).load_map, roevo.Options.read):
            with self.assertRaisesRegex(IsADirectoryError, str(folder)):
                read(folder)
        for save in (odometry.save_map, options.save):
            with self.assertRaisesRegex(FileNotFoundError, "such.map"):
                save(folder / "no" / "such.map")
            for other in (folder, folder / "fifo"):
                with self.assertRaisesRegex(OSError, f"cannot write {other}: it is a "):
                    save(other)


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
