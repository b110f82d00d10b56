#!/usr/bin/python3
"""Compares two files of `facewire track`, frame by frame, and says how far the landmarks lie apart in the picture.

usage: landmark_difference.py [--limit PX] A.jsonl B.jsonl

Exit code 1 when a face is only in one of the two or a landmark lies further apart than PX.
"""
import argparse
import itertools
import json
import math
import sys


def frames(path):
    with open(path, encoding="utf-8") as lines:
        for line in lines:
            yield json.loads(line)["landmarks"]


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1].splitlines()[0])
    parser.add_argument("--limit", type=float, default=math.inf)
    parser.add_argument("a")
    parser.add_argument("b")
    args = parser.parse_args()

    distances, both, one = [], 0, 0
    for a, b in itertools.zip_longest(frames(args.a), frames(args.b)):
        if bool(a) != bool(b):
            one += 1
        if not a or not b:
            continue
        both += 1
        distances += [math.dist(p[:2], q[:2]) for p, q in zip(a, b, strict=True)]
    if not distances:
        print("no face in both")
        return 1
    distances.sort()
    print(f"{both} frames with a face in both, {one} with a face in one only; "
          f"landmarks apart: mean {sum(distances) / len(distances):.4f} px, "
          f"99 % within {distances[len(distances) * 99 // 100]:.4f} px, most {distances[-1]:.4f} px")
    return 1 if one or distances[-1] > args.limit else 0


sys.exit(main())
