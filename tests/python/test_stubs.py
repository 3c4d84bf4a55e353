"""The type stubs name what the compiled part has, and everything public is described."""
import ast
import inspect
import os
import shutil
import subprocess
import tempfile
import unittest

import musclesim
from musclesim import _musclesim


def stub_names():
    """{class or "": names} of _musclesim.pyi."""
    with open(os.path.join(os.path.dirname(musclesim.__file__), "_musclesim.pyi"), encoding="utf-8") as file:
        tree = ast.parse(file.read())
    names = {"": {node.name for node in tree.body if isinstance(node, (ast.FunctionDef, ast.ClassDef))}}
    for node in tree.body:
        if isinstance(node, ast.ClassDef):
            names[node.name] = {part.name for part in node.body if isinstance(part, ast.FunctionDef)}
    return names


def own_names(thing):
    return {name for name in vars(thing) if not name.startswith("__") or name in ("__getitem__", "__contains__", "__iter__", "__len__", "__enter__",
                                                                                  "__exit__", "__init__")} - {"_pybind11_conduit_v1_"}


class Stubs(unittest.TestCase):
    def test_names(self):
        names = stub_names()
        self.assertEqual(names[""], own_names(_musclesim))
        for name, parts in names.items():
            if name:
                self.assertEqual(parts - {"__init__"}, own_names(getattr(_musclesim, name)) - {"__init__"}, name)

    @unittest.skipUnless(shutil.which("mypy"), "there is no mypy")
    def test_types(self):
        package = os.path.dirname(musclesim.__file__)
        with tempfile.TemporaryDirectory() as cache:
            result = subprocess.run(["mypy", "--strict", "--cache-dir", cache, package], capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stdout)

    def test_everything_public_is_described(self):
        for name in musclesim.__all__:
            thing = getattr(musclesim, name)
            if name == "__version__":
                continue
            self.assertTrue(inspect.getdoc(thing), name)


if __name__ == "__main__":
    unittest.main()
