"""The examples in Python run and do what they say."""
import os
import re
import subprocess
import sys
import tempfile
import unittest

examples = os.environ["MUSCLESIM_EXAMPLES"]

try:
    import matplotlib  # noqa: F401

    has_matplotlib = True
except ImportError:
    has_matplotlib = False


@unittest.skipUnless(has_matplotlib, "there is no python3-matplotlib")
class Examples(unittest.TestCase):
    def run_example(self, name):
        with tempfile.TemporaryDirectory() as folder:
            result = subprocess.run([sys.executable, os.path.join(examples, name)], cwd=folder, env=dict(os.environ, MPLBACKEND="Agg"),
                                    capture_output=True, text=True, timeout=280, check=False)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertGreater(os.path.getsize(os.path.join(folder, name.replace(".py", ".svg"))), 1000)
            return result.stdout

    def test_elbow_finds_the_cause_in_less_than_25_lines(self):
        with open(os.path.join(examples, "elbow.py"), encoding="utf-8") as file:
            self.assertLess(len(file.readlines()), 25)
        self.assertEqual(self.run_example("elbow.py"), "causes: ['valve_lag@all']\n")

    def test_notebook(self):
        self.assertTrue(re.search(r"best of ten: \d+\.\d degrees off", self.run_example("notebook.py")))


if __name__ == "__main__":
    unittest.main()
