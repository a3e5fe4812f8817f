"""The Python module: same bytes as roevo-odometry, arrays of all kinds, bad ones, threads."""
import ast
import copy
import os
import pathlib
import pickle
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy as np
from PIL import Image

import roevo

BIN = pathlib.Path(os.environ["ROEVO_BIN_DIR"])
OPTIONS = {"keyframe.max_translation": 0.02}  # several keyframes in a short recording


def run(program, *arguments):
    subprocess.run([str(BIN / program), *map(str, arguments)], check=True, stdout=subprocess.DEVNULL)


def read_list(file):
    lines = [line.split() for line in file.read_text().splitlines() if not line.startswith("#")]
    return [(float(stamp), name) for stamp, name in lines]


class Recording:
    """A simulated recording as TUM packs it: frames, camera, and what roevo-odometry makes of it."""

    def __init__(self, folder):
        self.folder, self.out = folder / "room", folder / "out"
        run("rawlog-simulate", "--scene", "livingroom", "--frames", 16, "--size", "320x240", "--layout", "tum",
            "--output", self.folder)
        values = dict(line.split("#")[0].split(":") for line in (self.folder / "camera.txt").read_text().splitlines()
                      if ":" in line.split("#")[0])
        self.camera = roevo.Camera(int(values["width"]), int(values["height"]),
                                   *(float(values[key]) for key in ("fx", "fy", "cx", "cy")))
        self.depth_scale = float(values["depth_scale"])
        pairs = zip(read_list(self.folder / "rgb.txt"), read_list(self.folder / "depth.txt"))
        self.frames = [(np.asarray(Image.open(self.folder / rgb)),
                        np.asarray(Image.open(self.folder / depth)).astype(np.uint16), stamp)
                       for (stamp, rgb), (_, depth) in pairs]
        settings = [word for name, value in OPTIONS.items() for word in ("--set", f"{name}={value}")]
        run("roevo-odometry", "--input", self.folder, "--output", self.out, "--quiet", "--map-out",
            folder / "room.map", "--covariances", folder / "covariances.txt", *settings)


def setUpModule():
    global scratch, folder, recording
    scratch = tempfile.TemporaryDirectory()
    folder = pathlib.Path(scratch.name)
    recording = Recording(folder)


def tearDownModule():
    scratch.cleanup()


def track(frames=None, convert=lambda array: array, odometry=None, **keywords):
    """An odometry that has seen the frames, and its results."""
    odometry = odometry or roevo.Odometry(recording.camera, roevo.Options(OPTIONS))
    keywords = keywords or {"depth_scale": recording.depth_scale}
    results = [odometry.process(convert(colour), convert(depth), stamp, **keywords)
               for colour, depth, stamp in frames or recording.frames]
    return odometry, results


def tum_text(trajectory):
    lines = [" ".join([f"{row[0]:.6f}", *(f"{value:.9f}" for value in row[1:])]) for row in trajectory]
    return "\n".join(["# timestamp tx ty tz qx qy qz qw", *lines, ""])


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
            for index in (16, -1):  # the result of a frame that was rejected has -1
                with self.assertRaises(IndexError):
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
        for file, words in (("text.map", "text.map: "), (".", "folder")):
            with self.assertRaisesRegex(RuntimeError, words) as raised:
                roevo.Odometry(recording.camera).load_map(folder / file)
            self.assertNotIn("\n", str(raised.exception))
        os.mkfifo(folder / "pipe")
        for read, kind in ((roevo.Odometry(recording.camera).load_map, RuntimeError), (roevo.Options.read, ValueError)):
            with self.assertRaisesRegex(kind, "pipe"):
                read(folder / "pipe")
        with self.assertRaisesRegex(RuntimeError, "keyframe"):
            roevo.Odometry(recording.camera).save_map(folder / "none.map")
        with self.assertRaises(RuntimeError):
            track()[0].save_map(folder / "no" / "such.map")


class OptionsAndCamera(unittest.TestCase):
    def test_options_are_those_of_the_ini(self):
        options = roevo.Options.read(recording.out / "config_used.ini")
        self.assertEqual(options["keyframe.max_translation"], 0.02)
        options.save(folder / "again.ini")
        self.assertEqual((folder / "again.ini").read_text(), (recording.out / "config_used.ini").read_text())
        self.assertEqual(dict(options), {name: options[name] for name in options})
        self.assertEqual({type(options[name]) for name in options}, {bool, int, float, str})
        (folder / "bad.ini").write_text("[edges]\nmin_length = zz\n")
        with self.assertRaisesRegex(ValueError, "bad.ini:2: .*zz"):
            roevo.Options.read(folder / "bad.ini")
        with self.assertRaises(FileNotFoundError):
            roevo.Options.read(folder / "no.ini")

    def test_options_and_cameras_are_values(self):
        options = roevo.Options(OPTIONS)
        self.assertEqual(repr(options), f"roevo.Options({OPTIONS})")
        self.assertEqual(repr(roevo.Options()), "roevo.Options()")
        self.assertNotEqual(options, roevo.Options())
        self.assertEqual(options.get("no.option", 7), 7)
        self.assertIn(("keyframe.max_translation", 0.02), options.items())
        for same in (roevo.Options(options), copy.deepcopy(options), pickle.loads(pickle.dumps(options)),
                     eval(repr(options)), roevo.Odometry(recording.camera, OPTIONS).options):
            self.assertEqual(same, options)
            same.update({"keyframe.max_translation": 0.03})
            self.assertNotEqual(same, options)
        self.assertRegex(options.describe("odometry.threads"), ", 0 to 256$")
        with self.assertRaisesRegex(TypeError, "^options must be roevo.Options or a dict, not str$"):
            roevo.Odometry(recording.camera, "tr")
        for camera in (recording.camera, roevo.Camera(640, 480, 525, 525, 320, 240, [[0.1, 0.01, 0, 0, 0.001]]),
                       roevo.Camera(640, 480, 525, 525, 320, 240, np.array([0.1, 0.01, 0, 0, 0.001, 0.2, 0.02, 0])),
                       roevo.Camera(640, 480, 300, 300, 320, 240, fisheye=[0.1, 0.01, 0, 0])):
            for same in (copy.deepcopy(camera), pickle.loads(pickle.dumps(camera)), eval(repr(camera))):
                self.assertEqual((same, hash(same), repr(same)), (camera, hash(camera), repr(camera)))
            self.assertEqual(roevo.Odometry(camera).camera, camera)

    def test_options_are_set_and_checked_by_name(self):
        options = roevo.Options({"odometry.mode": "tr", "loss.recognise": False, "edges.min_length": 12})
        self.assertEqual(options["odometry.mode"], "tr")
        self.assertIs(options["loss.recognise"], False)
        options["loss.recognise"] = np.bool_(True)
        self.assertIs(options["loss.recognise"], True)
        options["loss.recognise"] = False
        self.assertEqual(options["edges.min_length"], 12)
        self.assertIn("px", options.describe("edges.min_length"))
        self.assertRegex(options.describe("loss.recognise"), ", True or False$")
        self.assertIn("edges.min_length", options)
        self.assertNotIn("edges.min", options)
        for name, value, words in (("edges.min_lenght", 12, "edges.min_length"), ("edges.min_length", 12.5, "12.5"),
                                   ("edges.min_length", 1, "outside 3 to 1000"), ("odometry.mode", None, "None")):
            with self.assertRaisesRegex(ValueError, words):
                options[name] = value
        self.assertEqual(options["edges.min_length"], 12)
        with self.assertRaisesRegex(KeyError, "closest"):
            options["edges.min_lenght"]
        options["sensor.max_depth"] = 0.15
        with self.assertRaisesRegex(ValueError, "sensor.max_depth"):
            roevo.Odometry(recording.camera, options)

    def test_cameras_and_starts_are_checked(self):
        with self.assertRaisesRegex(ValueError, "fx"):
            roevo.Camera(640, 480, -525, 525, 319.5, 239.5)
        camera = roevo.Camera(640, 480, 517.30642, 516.46921, 318.64312, 255.31398, [0.2624, -0.9531, 0, 0, 1.1633])
        self.assertEqual(eval(repr(camera)), camera)
        self.assertNotEqual(camera, None)
        self.assertEqual(roevo.Camera(640, 480, 525, 525, 319.5, 239.5, distortion=[0.1, 0, 0, 0, 0]).distortion[0], 0.1)
        self.assertEqual(len(roevo.Camera(640, 480, 525, 525, 320, 240, [0.1, 0, 0, 0, 0, 0.2, 0, 0]).distortion), 8)
        fisheye = roevo.Camera(640, 480, 300, 300, 320, 240, fisheye=[0.1, 0.01, 0, 0])
        self.assertEqual((fisheye.distortion, fisheye.fisheye), ([], [0.1, 0.01, 0, 0]))
        for words, lens in (("4, 5 or 8 numbers", {"distortion": 6 * [0]}), ("4 numbers", {"fisheye": 5 * [0]}),
                            ("not both", {"distortion": 4 * [0.1], "fisheye": 4 * [0.1]})):
            with self.assertRaisesRegex(ValueError, words):
                roevo.Camera(640, 480, 525, 525, 319.5, 239.5, **lens)
        start = np.eye(4)
        start[:3, 3] = 1, 2, 3
        odometry = roevo.Odometry(recording.camera, T_world_start=start)
        _, results = track(recording.frames[:1], odometry=odometry)
        np.testing.assert_allclose(results[0].pose, start, atol=1e-12)
        for bad in (2 * np.eye(4), np.diag([1, 1, -1, 1.0]), np.full((4, 4), np.nan)):
            with self.assertRaisesRegex(ValueError, "rigid"):
                roevo.Odometry(recording.camera, T_world_start=bad)
        with self.assertRaisesRegex(ValueError, "4 x 4"):
            roevo.Odometry(recording.camera, T_world_start=np.eye(3))

    def test_everything_is_documented(self):
        for owner in (roevo, roevo.Camera, roevo.Options, roevo.Odometry, roevo.FrameResult, roevo.MapEdge, roevo.Keyframe):
            self.assertTrue(owner.__doc__)
        for name, member in vars(roevo.Odometry).items():
            if isinstance(member, property):
                self.assertTrue(member.__doc__, name)
            elif not name.startswith("_"):
                self.assertIn("\n", member.__doc__, name)  # more than the signature

    def test_the_stub_has_what_the_module_has(self):
        def public(owner):
            return {name for name in owner if not name.startswith("_")}

        stub = ast.parse((pathlib.Path(__file__).resolve().parents[2] / "python" / "roevo.pyi").read_text())
        named = {node.name: node for node in stub.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        self.assertEqual(set(named), public(vars(roevo)))
        inherited = {"keys", "values", "items", "get"}  # of Mapping
        for name, node in named.items():
            if not isinstance(node, ast.ClassDef):
                continue
            members = {member.name: member for member in node.body}
            self.assertEqual(public(members), public(vars(getattr(roevo, name))) - inherited, name)
            for member in public(members):
                is_property = isinstance(vars(getattr(roevo, name))[member], property)
                decorators = [decorator.id for decorator in members[member].decorator_list]
                self.assertEqual("property" in decorators, is_property, f"{name}.{member}")
            for method in public(members) - inherited:
                arguments = members[method].args
                shown = getattr(roevo, name).__dict__[method].__doc__ or ""
                for argument in arguments.args[1:] + arguments.kwonlyargs:
                    self.assertIn(argument.arg + ":", shown, f"{name}.{method}")


class Processes(unittest.TestCase):
    def script(self, text):
        begin = f"""if True:
            import os, sys, threading, time, numpy, roevo
            odometry = roevo.Odometry(roevo.Camera(320, 240, 262, 262, 160, 120))
            grey = (numpy.indices((240, 320)).sum(0) * 5 % 251).astype(numpy.uint8)
            depth = numpy.ones((240, 320), numpy.float32)
            assert odometry.process(grey, depth, 1).status == "initialised"
            """
        return subprocess.run([sys.executable, "-c", begin + text], timeout=60, text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT)

    def test_python_ends_while_a_thread_is_at_work(self):
        ended = self.script("""
            def work():
                for stamp in range(2, 100000):
                    odometry.process(grey, depth, stamp)
            threading.Thread(target=work, daemon=True).start()
            time.sleep(0.2)""")
        self.assertEqual((ended.returncode, ended.stdout), (0, ""))

    def test_a_forked_child_can_end_and_is_told_to_make_its_own(self):
        ended = self.script("""
            child = os.fork()
            if child == 0:
                try:
                    odometry.process(grey, depth, 2)
                except RuntimeError as fault:
                    print(fault, flush=True)
                del odometry
                sys.exit(7)
            print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))""")
        self.assertEqual(ended.stdout, "this Odometry was made before fork(): make another in this process\n7\n")


class Threads(unittest.TestCase):
    def test_python_runs_while_a_frame_is_tracked(self):
        ticks, done = [], threading.Event()

        def tick():
            while not done.is_set():
                ticks.append(time.monotonic())
                time.sleep(0.0002)

        ticker = threading.Thread(target=tick)
        ticker.start()
        odometry, _ = track(recording.frames[:4])
        start = time.monotonic()
        odometry.refine_all()
        for colour, depth, stamp in recording.frames[4:]:
            odometry.process(colour, depth, stamp, depth_scale=recording.depth_scale)
        end = time.monotonic()
        done.set()
        ticker.join()
        inside = [moment for moment in ticks if start < moment < end]
        # With the lock of Python held, a tick would come between the calls only
        self.assertGreater(len(inside), 3 * len(recording.frames[4:]))

    def test_odometries_in_threads_do_not_mix(self):
        expected = track()[0].trajectory()
        found = [None] * 4

        def work(i):
            found[i] = track()[0].trajectory()

        threads = [threading.Thread(target=work, args=(i,)) for i in range(len(found))]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for trajectory in found:
            np.testing.assert_array_equal(trajectory, expected)

    def test_threads_may_share_one(self):
        odometry = roevo.Odometry(recording.camera, roevo.Options(OPTIONS))
        done = threading.Event()
        shapes = []

        def look():
            while not done.is_set():
                shapes.append((odometry.trajectory().shape[0], len(odometry.map_edges()), len(odometry.keyframes())))

        watchers = [threading.Thread(target=look) for _ in range(2)]
        for watcher in watchers:
            watcher.start()
        track(odometry=odometry)
        done.set()
        for watcher in watchers:
            watcher.join()
        self.assertTrue(shapes)
        np.testing.assert_array_equal(odometry.trajectory(), track()[0].trajectory())


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
