"""The program that is checked by `mypy --strict` also runs."""

import runpy
from pathlib import Path


def test_the_typed_program_runs():
    runpy.run_path(str(Path(__file__).with_name("typed_program.py")), run_name="__main__")
