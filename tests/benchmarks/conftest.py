"""Benchmarks are scripts that import each other: their folder is on the path."""

import sys

from tests.conftest import ROOT

sys.path.insert(0, str(ROOT / "benchmarks"))
