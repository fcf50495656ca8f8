"""numpy's sort of words without a sign, in the protocol of protocol.hpp: sort.py INPUT SORTED.

INPUT holds words of 64 bits where others have doubles; they come back in order in SORTED. Seconds are processor time of
this thread. Which vectors numpy takes is said by NPY_DISABLE_CPU_FEATURES before it is started.
"""

import json
import sys
import time

import numpy


def main():
    input_path, sorted_path = sys.argv[1:]
    with open(input_path, "rb") as file:
        rows, columns = numpy.fromfile(file, dtype="<u8", count=2)
        given = numpy.fromfile(file, dtype="<u8", count=int(rows * columns))
    work = given.copy()
    print(json.dumps({"ready": True}), flush=True)
    for _ in sys.stdin:
        work[:] = given
        start = time.thread_time()
        work.sort()
        seconds = time.thread_time() - start
        work.tofile(sorted_path)
        print(json.dumps({"seconds": seconds, "radius": 0.0, "support": 0}), flush=True)


if __name__ == "__main__":
    main()
