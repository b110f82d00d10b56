#!/usr/bin/env python3
"""Makes the training files of app/share/average.profile from renderings of an average head.

Reads   DATA/average/average_{poses,extra_poses,shuffled_poses}.jsonl.gz   landmarks in known poses
        DATA/models/canonical_face_model.obj, procrustes_basis.json        MediaPipe's canonical face
Writes  OUT/markers.csv, OUT/targets.csv                                   for facewire train
        OUT/average.regions.toml                                           how the face is divided

Run: python3 tools/generate/average_training.py DATA OUT      (needs python3-numpy)
README.md beside this file has the whole recipe and why it is this one.
"""
import gzip
import json
import pathlib
import sys

import numpy as np

ROWS = 420
SEED = 0
# ARKit's eyeBlink is 1 when the lids touch. In the recorded rows they already touch at 0.83 on
# average, because looking down and squinting close them too: 1 / 0.83.
BLINK_GAIN = 1.2

RIGHT_LIDS = [33, 7, 163, 144, 145, 153, 154, 155, 133, 173, 157, 158, 159, 160, 161, 246]
LEFT_LIDS = [263, 249, 390, 373, 374, 380, 381, 382, 362, 398, 384, 385, 386, 387, 388, 466]
RIGHT_CORNERS, LEFT_CORNERS = [33, 133], [263, 362]
RIGHT_SOCKET, LEFT_SOCKET = [130, 24, 56, 27], [359, 254, 286, 257]
RIGHT_IRIS, LEFT_IRIS = [468], [473]
RIGHT_GAPS = [(159, 145), (158, 153), (160, 144)]
LEFT_GAPS = [(386, 374), (385, 380), (387, 373)]
BROWS = [70, 63, 105, 66, 107, 300, 293, 334, 296, 336]
NOSE_ROOT = [6, 168, 197]
NOSE = [1, 2, 98, 327, 4, 5]
CHEEKS = [50, 280, 205, 425, 187, 411, 117, 346]
CHIN = [152, 148, 377, 199]
INNER_LIPS = [13, 14, 82, 87, 312, 317, 81, 178, 311, 402, 78, 308, 191, 415]
OUTER_LIPS = [61, 291, 0, 17, 37, 267, 84, 314, 39, 269, 181, 405, 40, 270]
LIP_GAPS = [(13, 14), (82, 87), (312, 317), (81, 178), (311, 402)]


def starts(*prefixes):
    return lambda name: name.startswith(prefixes)


def eye(side):
    return lambda n: n.startswith("eye") and n.endswith(side) and not n.startswith("eyeBlink")


# name, targets, points, origin, gaps, gain of the gaps, axes, smoothing, smoothing of the tail
# Few axes for the lids: they move in few ways, and a lid that closes unlike the training's lids (a plain
# closing of the average face) then still reads as 0.7 instead of 0.5.
REGIONS = [
    ("blinkRight", lambda n: n == "eyeBlinkRight", RIGHT_LIDS, RIGHT_CORNERS, RIGHT_GAPS, 3, 8, 0.05, 0.1),
    ("blinkLeft", lambda n: n == "eyeBlinkLeft", LEFT_LIDS, LEFT_CORNERS, LEFT_GAPS, 3, 8, 0.05, 0.1),
    ("eyeRight", eye("Right"), RIGHT_LIDS + RIGHT_SOCKET + RIGHT_IRIS, RIGHT_CORNERS, [], 1, 24, 0.5, 1),
    ("eyeLeft", eye("Left"), LEFT_LIDS + LEFT_SOCKET + LEFT_IRIS, LEFT_CORNERS, [], 1, 24, 0.5, 1),
    ("brows", starts("brow"), BROWS, NOSE_ROOT + [133, 362], [], 1, 24, 0.5, 1),
    ("jaw", lambda n: n == "jawOpen", INNER_LIPS, INNER_LIPS, LIP_GAPS, 6, 24, 1, 10),
    ("mouth", starts("mouth", "cheekPuff", "jawLeft", "jawRight", "jawForward"),
     INNER_LIPS + OUTER_LIPS + CHIN + NOSE + CHEEKS, [], [], 1, 24, 2, 50),
    ("cheeks", starts("cheekSquint", "noseSneer"),
     CHEEKS + NOSE + RIGHT_SOCKET + LEFT_SOCKET + OUTER_LIPS[::3], [], [], 1, 24, 0.5, 10),
]

class ObjectSpace:
    """Landmarks in pixels to the canonical face's space (cm): the weighted similarity fit of core/pose."""

    def __init__(self, models):
        lines = (models / "canonical_face_model.obj").read_text().splitlines()
        face = np.array([[float(t) for t in l.split()[1:4]] for l in lines if l.startswith("v ")])
        basis = json.loads((models / "procrustes_basis.json").read_text())["procrustes_landmark_basis"]
        self.index = np.array([b[0] for b in basis])
        self.weight = np.array([b[1] for b in basis])
        self.weight /= self.weight.sum()
        self.target = face[self.index]

    def __call__(self, landmarks):
        points = np.asarray(landmarks, float) * [1, -1, -1]
        source = points[self.index]
        mean_s, mean_t = self.weight @ source, self.weight @ self.target
        s, t = source - mean_s, self.target - mean_t
        u, sigma, v = np.linalg.svd((t * self.weight[:, None]).T @ s)
        sign = np.array([1, 1, np.sign(np.linalg.det(u @ v))])
        scale = (sigma * sign).sum() / (self.weight @ (s**2).sum(1))
        return scale * (points - mean_s) @ ((u * sign) @ v).T + mean_t


def read(path):
    with gzip.open(path, "rt") as lines:
        return [json.loads(line) for line in lines]


def choose(poses):
    """The frontal neutral first, every constructed pose, then recorded and shuffled ones."""
    rng = np.random.RandomState(SEED)
    kinds = np.array([p["kind"] for p in poses])
    first = [i for i, p in enumerate(poses) if p["id"] == "neutral_00"]
    made = [i for k in ("headneutral", "combo", "pair") for i in np.flatnonzero(kinds == k)]
    # A third of a weak shape is within the tracker's noise.
    made += [i for i in np.flatnonzero(kinds == "unit") if "035" not in poses[i]["id"]]
    real = list(rng.permutation(np.flatnonzero(kinds == "real")))[:160]
    shuffled = list(rng.permutation(np.flatnonzero(kinds == "shuffled")))
    return (first + made + real + shuffled)[:ROWS]


def inputs(x, marker, points, origin, gaps, gain):
    at = x[:, [marker[p] for p in points]]
    if origin:
        at = at - x[:, [marker[p] for p in origin]].mean(1, keepdims=True)
    heights = [gain * (x[:, marker[a], 1] - x[:, marker[b], 1]) for a, b in gaps]
    return np.c_[at.reshape(len(x), -1), np.array(heights).T.reshape(len(x), -1)]


def median_distance(f):
    d = np.sqrt(((f[:, None] - f[None]) ** 2).sum(2))
    return np.median(d[np.triu_indices(len(f), 1)])


def main():
    data, out = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    out.mkdir(parents=True, exist_ok=True)
    poses = [p for part in ("poses", "extra_poses", "shuffled_poses")
             for p in read(data / f"average/average_{part}.jsonl.gz")]
    poses = [poses[i] for i in choose(poses)]
    names = json.loads((data / "average/average_poses.header.json").read_text())["weight_names"]
    fit = ObjectSpace(data / "models")
    markers = sorted({m for r in REGIONS for m in r[2] + r[3] + [e for d in r[4] for e in d]})
    x = np.array([fit(p["landmarks"])[markers] for p in poses]).round(4)
    weights = np.array([[p["weights"].get(n, 0) for n in names] for p in poses])
    blink = [names.index("eyeBlinkLeft"), names.index("eyeBlinkRight")]
    weights[:, blink] = np.minimum(1, BLINK_GAIN * weights[:, blink])

    with open(out / "markers.csv", "w") as f:
        f.write(",".join(f"lm{m}_{axis}" for m in markers for axis in "xyz") + "\n")
        for row in x:
            f.write(",".join(f"{v:.4f}" for v in row.ravel()) + "\n")
    with open(out / "targets.csv", "w") as f:
        f.write(",".join(names) + "\n")
        for row in weights:
            f.write(",".join(f"{v:.4f}" for v in row) + "\n")

    index = {m: i for i, m in enumerate(markers)}
    with open(out / "average.regions.toml", "w") as f:
        f.write("# Written by tools/generate/average_training.py; for facewire train --regions.\n")
        for name, wanted, points, origin, gaps, gain, axes, smoothing, tail_smoothing in REGIONS:
            epsilon = 1 / median_distance(inputs(x, index, points, origin, gaps, gain))
            f.write(f'\n[[region]]\nname = "{name}"\nkernel = "multiquadric"\ntail = "linear"\n')
            f.write(f"epsilon = {epsilon:.4f}\nsmoothing = {smoothing}\n")
            f.write(f"tail_smoothing = {tail_smoothing}\n")
            f.write(f"axes = {axes}\n")
            f.write("targets = " + json.dumps([n for n in names if wanted(n)]) + "\n")
            f.write("points = " + json.dumps([f"lm{p}" for p in points]) + "\n")
            if origin:
                f.write("origin = " + json.dumps([f"lm{p}" for p in origin]) + "\n")
            if gaps:
                f.write(f"gap_gain = {gain}\n")
                f.write("gaps = " + json.dumps([[f"lm{a}", f"lm{b}"] for a, b in gaps]) + "\n")


if __name__ == "__main__":
    main()
