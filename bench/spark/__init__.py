"""What is promised of `taut.spark`, each promise with its figure; `scripts/spark` runs the parts."""

from . import answers, input, kills, passes, times, triangulations, verify

PARTS = {
    "answers": answers,
    "kills": kills,
    "passes": passes,
    "times": times,
    "verify": verify,
    "triangulations": triangulations,
    "input": input,
}
