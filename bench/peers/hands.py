"""OpenCV on one thread in the protocol of protocol.hpp: hands.py WAY INPUT CENTER.

WAY is `distance`: the distances of the pixels that are 1 to the nearest one that is 0, precise masks; the output has their squares.
Or `outline`: the rows are those of an image with three numbers for each pixel; CIELAB, Otsu's threshold of b*, opening, the outline of the
largest component. The radius is the area in it, and the output has its points.
"""

import json
import sys
import time

import cv2
import numpy


def distance(rows):
    return cv2.distanceTransform(rows, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)


def outline(rows):
    b = cv2.cvtColor(rows, cv2.COLOR_RGB2LAB)[:, :, 2]
    _, mask = cv2.threshold(b, 0, 255, cv2.THRESH_BINARY | cv2.THRESH_OTSU)
    mask = cv2.morphologyEx(mask, cv2.MORPH_OPEN, cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (5, 5)))
    outlines, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    return max(outlines, key=cv2.contourArea)


def main():
    way, input_path, output_path = sys.argv[1:]
    cv2.setNumThreads(1)
    with open(input_path, "rb") as file:
        rows, columns = (int(count) for count in numpy.fromfile(file, dtype="<u8", count=2))
        values = numpy.fromfile(file, dtype="<f8").reshape(rows, columns).astype(numpy.uint8)
    if way == "outline":
        values = values.reshape(rows, columns // 3, 3)
    print(json.dumps({"ready": True}), flush=True)
    for _ in sys.stdin:
        start = time.perf_counter()
        found = {"distance": distance, "outline": outline}[way](values)
        seconds = time.perf_counter() - start
        if way == "distance":
            radius, found = float(found.max()), found.astype("<f8") ** 2
        else:
            radius = cv2.contourArea(found)
        numpy.asarray(found).astype("<f8").tofile(output_path)
        print(json.dumps({"seconds": seconds, "radius": radius, "support": 0}), flush=True)


if __name__ == "__main__":
    main()
