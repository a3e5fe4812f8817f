"""The Python module: options, cameras and the stub; processes that end or fork; threads."""
import ast
import copy
import os
import pathlib
import pickle
import subprocess
import sys
import threading
import time
import types
import unittest

import numpy as np

import roevo
from simulated import OPTIONS, folder, recording, track


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

    def test_any_mapping_of_options_is_taken_wholly_or_not_at_all(self):
        values = types.MappingProxyType({"odometry.mode": "tr", "fine.max_points": 2000.0})
        options, other = roevo.Options(values), roevo.Options()
        self.assertEqual(options["fine.max_points"], 2000)
        self.assertIs(type(options["fine.max_points"]), int)
        self.assertEqual(roevo.Odometry(recording.camera, values).options, options)
        other.update(options)
        self.assertEqual(other, options)
        with self.assertRaisesRegex(ValueError, "fine.chi2"):
            other.update({"odometry.mode": "ct", "fine.chi2": -5})
        self.assertEqual(other, options)
        options["fine.max_points"] = np.float32(3000)
        self.assertEqual(options["fine.max_points"], 3000)
        for value in (3000.5, "3000.0"):
            with self.assertRaisesRegex(ValueError, "is not a whole number"):
                options["fine.max_points"] = value
        for none in ("tr", [("odometry.mode", "tr")], None):
            with self.assertRaisesRegex(TypeError, "^options must be "):
                other.update(none)

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
        assigned = {target.id for node in stub.body if isinstance(node, ast.Assign) for target in node.targets}
        self.assertEqual(public(assigned), set())  # what only the stub has is nobody's to import
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
