"""The tour of the package, as somebody takes it who has just installed it."""

import subprocess
import sys


def test_the_tour_passes():
    ran = subprocess.run([sys.executable, "-m", "taut", "tour"], capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    assert ran.stdout.splitlines()[-1].startswith("10 stops, each answer verified")


def test_other_words_are_refused():
    ran = subprocess.run([sys.executable, "-m", "taut"], capture_output=True, text=True, check=False)
    assert ran.returncode == 1 and "usage" in ran.stderr
