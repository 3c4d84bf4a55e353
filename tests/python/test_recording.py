"""Recordings to and from dicts of arrays."""
import copy
import os
import pathlib
import pickle
import tempfile
import unittest

import numpy as np

import musclesim


def small():
    time_s = np.arange(5) * 0.1
    return {"time_s": time_s, "command_0": np.full(5, 0.5), "length_0_mm": np.array([250, 249.5, np.nan, 0.1 + 0.2, 1e-300])}


class Recordings(unittest.TestCase):
    def test_from_dict_and_back(self):
        recording = musclesim.Recording.from_dict(small(), robot="rig", noise_std={"length_0_mm": 0.05})
        self.assertEqual(recording.keys(), ["time_s", "command_0", "length_0_mm"])
        for name, values in small().items():
            np.testing.assert_array_equal(recording[name], values)
        self.assertEqual(recording.info, {"format": "musclesim-recording-1", "robot": "rig", "noise_std": {"length_0_mm": 0.05}})
        again = musclesim.Recording.from_dict(recording.to_dict(), **recording.info)
        for name in recording.keys():
            np.testing.assert_array_equal(recording[name], again[name])
        self.assertEqual((recording.robot, len(recording), "command_0" in recording, "command_1" in recording), ("rig", 5, True, False))

    def test_can_be_copied_and_sent_to_another_process(self):
        recording = musclesim.Recording.from_dict(small(), robot="rig", noise_std={"length_0_mm": 0.05})
        for again in (copy.deepcopy(recording), pickle.loads(pickle.dumps(recording))):
            self.assertEqual((list(again), again.info), (list(recording), recording.info))
            for name in recording:
                np.testing.assert_array_equal(recording[name], again[name])

    def test_arrays_are_views_that_outlive_the_recording(self):
        recording = musclesim.Recording.from_dict(small(), robot="rig")
        lengths = recording["length_0_mm"]
        self.assertTrue(np.shares_memory(lengths, recording.to_dict()["length_0_mm"]))
        self.assertFalse(lengths.flags.writeable)
        del recording
        self.assertEqual(lengths[0], 250)

    def test_units_are_converted(self):
        arrays = dict(small(), pressure_0_kPa=np.full(5, 300.0), length_0_m=np.full(5, 0.25))
        del arrays["length_0_mm"]
        recording = musclesim.Recording.from_dict(arrays, robot="rig", pressure_full_scale_kPa=600)
        self.assertEqual((recording["pressure_0"][0], recording["length_0_mm"][0]), (0.5, 250))
        self.assertTrue(any("converted" in note for note in recording.notes))

    def test_files(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "small.csv")
            musclesim.Recording.from_dict(small(), robot="rig").write(file)
            for name, values in small().items():
                np.testing.assert_array_equal(musclesim.Recording.read(file)[name], values)
            musclesim.Recording.read(pathlib.Path(file)).write(pathlib.Path(folder, "again.csv"))
            with open(file, "rb") as first, open(os.path.join(folder, "again.csv"), "rb") as again:
                self.assertEqual(first.read(), again.read())
            os.remove(file.replace(".csv", ".json"))
            with self.assertRaisesRegex(musclesim.BadFile, "sidecar"):
                musclesim.Recording.read(file)
            with self.assertRaises(musclesim.IoError):
                musclesim.Recording.read(os.path.join(folder, "none.csv"))
            with open(file, "w", encoding="utf-8") as broken:
                broken.write("time_s,command_0\n0,0.5\n0.1,fast\n")
            with open(file.replace(".csv", ".json"), "w", encoding="utf-8") as sidecar:
                sidecar.write('{"format": "musclesim-recording-1", "robot": "rig"}')
            with self.assertRaises(musclesim.BadFile) as caught:
                musclesim.Recording.read(file)
            self.assertEqual((caught.exception.file, caught.exception.line), (file, 3))

    def test_refusals(self):
        def changed(**columns):
            return dict(small(), **columns)

        for arrays, pattern in ((changed(command_0=np.full(4, 0.5)), r"command_0 = shape \(4,\): must be \(5,\), as time_s"),
                                (changed(command_0=np.full((5, 1), 0.5)), "one axis"),
                                (changed(command_0=np.full(5, np.nan)), "every muscle's command"),
                                (changed(command_0=np.full(5, 1.5)), r"must lie in 0 \.\. 1"),
                                (changed(time_s=np.zeros(5)), "strictly increasing"), (changed(length_0_mm=np.full(5, np.inf)), "finite"),
                                (changed(speed=np.zeros(5)), "speed"), (changed(length_0_mm=["a"] * 5), "numbers"), ({}, "needs columns"),
                                ({"a,b": np.zeros(2)}, "column name"), ({"time_s": []}, ".")):
            with self.assertRaisesRegex((musclesim.BadParameter, musclesim.BadFile), pattern):
                musclesim.Recording.from_dict(arrays, robot="rig")
        with self.assertRaisesRegex(musclesim.BadFile, "physics"):
            musclesim.Recording.from_dict(small(), robot="rig", physics="moon")
        with self.assertRaisesRegex(KeyError, "there is no column lenght_0_mm; did you mean length_0_mm.; the columns are time_s, command_0"):
            musclesim.Recording.from_dict(small(), robot="rig")["lenght_0_mm"]

    def test_replay_refuses(self):
        recording = musclesim.Recording.from_dict(small(), robot="elbow")
        with self.assertRaisesRegex(musclesim.BadFile, "command"):
            musclesim.replay(recording)
        with self.assertRaisesRegex(TypeError, "colour"):
            musclesim.replay(recording, colour="red")


if __name__ == "__main__":
    unittest.main()
