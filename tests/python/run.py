"""Runs the tests of one file: run.py test_simulation. Exit status 77 (skipped) without NumPy."""
import os
import sys
import unittest

try:
    import numpy  # noqa: F401
except ImportError:
    print("skipped: there is no python3-numpy")
    sys.exit(77)

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
unittest.main(module=sys.argv[1], argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
