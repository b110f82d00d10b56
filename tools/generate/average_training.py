#!/usr/bin/env python3
"""Makes the training files of app/share/average.profile from renderings of an average head.

Reads   DATA/average/average_{poses,extra_poses,shuffled_poses}.jsonl.gz   landmarks in known poses
Writes  OUT/poses.jsonl, OUT/poses.csv                                     the same in object space, by facewire record
        OUT/markers.csv, OUT/targets.csv, OUT/weights.csv                  for facewire train
        OUT/average.regions.toml                                           how the face is divided

Run: python3 tools/generate/average_training.py DATA OUT [--facewire build/dev/tools/facewire/facewire]
     [--without-recorded]      (needs python3-numpy)
README.md beside this file has the whole recipe and why it is this one.
"""
import argparse
import gzip
import json
import pathlib
import subprocess

import numpy as np

PARTS = ("poses", "extra_poses", "shuffled_poses")
SIZE_PX = (640, 480)
# Of 400 recorded rows. All of them would raise the correlations by 0.002 at most.
RECORDED = 275
# A sample's smoothing is divided by its weight. The neutral's makes it exact: a face at rest gives zero. The recorded
# rows show how shapes go together; with equal weights the more extreme constructed poses drown them.
# Shuffled rows (only without recorded ones) show how they don't: they steady what the constructed poses say, no more.
NEUTRAL_WEIGHT = 1000
WEIGHTS = {"real": 8, "shuffled": 0.01}
# The rendered eyeballs do not turn: the model's eyeLook shapes move lids only. So the irises are carried as an eyeball would
# carry them. At weight 1, Live Link Face turns the eye by 0.58 to 0.63 rad sideways, 0.62 down and 0.45 up (regression of
# alex_rom_3's eye angles on its weights).
EYE_RADIUS_CM = 1.2
SIDEWAYS_RAD, DOWN_RAD, UP_RAD = 0.6, 0.62, 0.45

RIGHT_LIDS = [33, 7, 163, 144, 145, 153, 154, 155, 133, 173, 157, 158, 159, 160, 161, 246]
LEFT_LIDS = [263, 249, 390, 373, 374, 380, 381, 382, 362, 398, 384, 385, 386, 387, 388, 466]
CORNERS = [33, 133, 263, 362]
OUTER_CORNERS = [33, 263]
SOCKETS = [130, 24, 56, 27, 359, 254, 286, 257]
IRISES = [468, 473]
LID_GAPS = [(159, 145), (158, 153), (160, 144), (386, 374), (385, 380), (387, 373)]
BROWS = [70, 63, 105, 66, 107, 300, 293, 334, 296, 336, 46, 53, 52, 65, 55, 276, 283, 282, 295, 285]
NOSE_ROOT = [6, 168, 197]
SIDES = [234, 454]
# Beside the outer corners, where a blink moves the skin least.
BESIDE_EYES = [113, 342]
INNER_LIPS = [13, 14, 82, 87, 312, 317, 81, 178, 311, 402, 78, 308, 191, 415]
OUTER_LIPS = [61, 291, 0, 17, 37, 267, 84, 314, 39, 269, 181, 405, 40, 270]
# Top, bottom and corners: from their own middle, the form of the lips does not depend on where the tracker puts the mouth.
MOUTH_ENDS = [0, 17, 61, 291]
LIP_GAPS = [(13, 14), (82, 87), (312, 317), (81, 178), (311, 402)]
CHIN = [172, 397, 400, 176, 175, 394, 169]
# The rest of the lower face, evenly: each the farthest from those before it and from the lips.
LOWER_FACE = [454, 234, 448, 228, 419, 196, 147, 376, 36, 266, 132, 361, 4, 207, 427, 137, 366, 451, 231, 116, 345] + CHIN
EYES = RIGHT_LIDS + LEFT_LIDS + SOCKETS
# Corners alone go up and down with a squint.
AROUND_EYES = CORNERS + SOCKETS + [6]
MOUTH = INNER_LIPS + OUTER_LIPS + LOWER_FACE


def starts(*prefixes):
    return lambda name: name.startswith(prefixes)


def is_gaze(name):
    return name.startswith(("eyeLookIn", "eyeLookOut"))


def is_of_lips(name):
    return name.startswith(("mouthPucker", "mouthSmile", "cheekPuff"))


# name, targets, points, origin, gaps, gain of the gaps, axes, epsilon times median distance, smoothing, smoothing of the tail
REGIONS = [
    ("blinks", starts("eyeBlink"), EYES, AROUND_EYES, LID_GAPS, 5, 24, 1, 0.6, 3),
    ("eyes", lambda n: n.startswith("eye") and not n.startswith("eyeBlink") and not is_gaze(n), EYES, AROUND_EYES, [], 1,
     16, 1.5, 1.5, 60),
    ("gaze", is_gaze, IRISES, CORNERS, [], 1, 0, 1, 0.5, 1),
    ("brows", starts("brow"), BROWS, NOSE_ROOT + [133, 362], [], 1, 24, 1, 1, 1),
    ("jaw", lambda n: n == "jawOpen", CHIN, NOSE_ROOT + SIDES + OUTER_CORNERS, LIP_GAPS, 24, 16, 0.5, 0.7, 10),
    ("lips", is_of_lips, INNER_LIPS + OUTER_LIPS, MOUTH_ENDS, [], 1, 24, 2, 1.5, 60),
    ("mouth", lambda n: n.startswith(("mouth", "jaw")) and n != "jawOpen" and not is_of_lips(n), MOUTH,
     [6, 168] + BESIDE_EYES, [], 1, 32, 1.1, 1.5, 60),
    ("cheeks", starts("cheekSquint", "noseSneer"), MOUTH + EYES + BROWS, [], [], 1, 8, 2, 1.5, 200),
]


# A lid that closes makes the tracker see the brows move. Its main direction is taken out, and what is left of it is small.
# Of the eyes, too, only the beginning of a range is noise.
EXTRA = {"brows": 'ignores = ["eyeBlinkLeft", "eyeBlinkRight"]\ndead_zone = 0.1\n',
         "eyes": "dead_zone = 0.03\n"}


def read(path):
    with gzip.open(path, "rt") as lines:
        return [json.loads(line) for line in lines]


def to_object_space(facewire, poses, markers, out):
    """Poses x markers x 3, cm: as facewire sees a face, so that training and use see the same."""
    with open(out / "poses.jsonl", "w") as file:
        for i, pose in enumerate(poses):
            json.dump({"frame": i, "t_us": i * 1000000 // 30, "width": SIZE_PX[0], "height": SIZE_PX[1],
                       "landmarks": pose["landmarks"]}, file)
            file.write("\n")
    subprocess.run([facewire, "record", out / "poses.jsonl", "--unfiltered", "--markers",
                    ",".join(f"lm{m}" for m in markers), "--out", out / "poses.csv"], check=True)
    table = np.genfromtxt(out / "poses.csv", delimiter=",", names=True)
    columns = [table[f"lm{m}_{axis}"] for m in markers for axis in "xyz"]
    return np.stack(columns, 1).reshape(len(poses), len(markers), 3)


def most_different(rows, count):
    """Indices of rows: the first, then always the one farthest from all before."""
    chosen = [0]
    distance = np.linalg.norm(rows - rows[0], axis=1)
    while len(chosen) < count:
        chosen.append(int(distance.argmax()))
        distance = np.minimum(distance, np.linalg.norm(rows - rows[chosen[-1]], axis=1))
    return chosen


def choose(poses, weights, without_recorded):
    """The frontal neutral first, then constructed poses, neutrals in other head poses, and recorded or shuffled rows."""
    kinds = np.array([p["kind"] for p in poses])
    # A third of a weak shape is within the tracker's noise.
    strong = np.array(["035" not in p["id"] for p in poses])
    first = [i for i, p in enumerate(poses) if p["id"] == "neutral_00"]
    made = np.flatnonzero(np.isin(kinds, ["unit", "pair", "combo"]) & strong)
    turned = np.flatnonzero(kinds == "headneutral")
    if without_recorded:
        rest = np.flatnonzero(kinds == "shuffled")
    else:
        recorded = np.flatnonzero(kinds == "real")
        rest = recorded[most_different(weights[recorded], RECORDED)]
    return np.concatenate([first, made, turned, rest]).astype(int)


def turn_eyes(x, markers, rows, weights, names):
    """Gives the neutrals in other head poses a gaze each: irises and targets."""
    gazes = [(side, up) for side in (-1, -2 / 3, -1 / 3, 1 / 3, 2 / 3, 1) for up in (-0.4, 0, 0, 0.4)]
    for row, (side, down) in zip(rows, gazes):
        yaw = SIDEWAYS_RAD * side
        pitch = down * (DOWN_RAD if down > 0 else UP_RAD)
        for iris in IRISES:
            x[row, markers.index(iris)] += EYE_RADIUS_CM * np.array(
                [np.sin(yaw), -np.sin(pitch) * np.cos(yaw), np.cos(yaw) * np.cos(pitch) - 1])
        towards = ("eyeLookOutLeft", "eyeLookInRight") if side > 0 else ("eyeLookInLeft", "eyeLookOutRight")
        for name in towards:
            weights[row, names.index(name)] = abs(side)


def inputs(x, markers, points, origin, gaps, gain):
    at = x[:, [markers.index(p) for p in points]]
    if origin:
        at = at - x[:, [markers.index(p) for p in origin]].mean(1, keepdims=True)
    heights = [gain * (x[:, markers.index(a), 1] - x[:, markers.index(b), 1]) for a, b in gaps]
    return np.c_[at.reshape(len(x), -1), np.array(heights).T.reshape(len(x), -1)]


def median_distance(f):
    d = np.sqrt(((f[:, None] - f[None]) ** 2).sum(2))
    return np.median(d[np.triu_indices(len(f), 1)])


def write_table(path, names, rows):
    np.savetxt(path, rows, fmt="%.4f", delimiter=",", header=",".join(names), comments="")


def write_regions(path, x, markers, names):
    with open(path, "w") as f:
        f.write("# Written by tools/generate/average_training.py; for facewire train --regions.\n")
        for name, wanted, points, origin, gaps, gain, axes, radius, smoothing, tail_smoothing in REGIONS:
            epsilon = radius / median_distance(inputs(x, markers, points, origin, gaps, gain))
            f.write(f'\n[[region]]\nname = "{name}"\nkernel = "multiquadric"\ntail = "linear"\n')
            f.write(f"epsilon = {epsilon:.4f}\nsmoothing = {smoothing}\n")
            f.write(f"tail_smoothing = {tail_smoothing}\n")
            f.write(f"axes = {axes}\n")
            f.write(EXTRA.get(name, ""))
            f.write("targets = " + json.dumps([n for n in names if wanted(n)]) + "\n")
            f.write("points = " + json.dumps([f"lm{p}" for p in points]) + "\n")
            if origin:
                f.write("origin = " + json.dumps([f"lm{p}" for p in origin]) + "\n")
            if gaps:
                f.write(f"gap_gain = {gain}\n")
                f.write("gaps = " + json.dumps([[f"lm{a}", f"lm{b}"] for a, b in gaps]) + "\n")


def main():
    parser = argparse.ArgumentParser(description="Makes the training files of app/share/average.profile.")
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--facewire", default="build/dev/tools/facewire/facewire", help="the command (default: %(default)s)")
    parser.add_argument("--without-recorded", action="store_true", help="leave the recorded rows out: a measure of generality")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)

    poses = [p for part in PARTS for p in read(options.data / f"average/average_{part}.jsonl.gz")]
    names = json.loads((options.data / "average/average_poses.header.json").read_text())["weight_names"]
    markers = sorted({m for r in REGIONS for m in r[2] + r[3] + [e for d in r[4] for e in d]})
    x = to_object_space(options.facewire, poses, markers, options.out)
    targets = np.array([[p["weights"].get(n, 0) for n in names] for p in poses])
    turn_eyes(x, markers, [i for i, p in enumerate(poses) if p["kind"] == "headneutral"], targets, names)
    chosen = choose(poses, targets, options.without_recorded)
    weights = [NEUTRAL_WEIGHT if i == chosen[0] else WEIGHTS.get(poses[i]["kind"], 1) for i in chosen]

    x = x[chosen].round(4)
    write_table(options.out / "markers.csv", [f"lm{m}_{axis}" for m in markers for axis in "xyz"], x.reshape(len(x), -1))
    write_table(options.out / "targets.csv", names, targets[chosen])
    write_table(options.out / "weights.csv", ["weight"], weights)
    write_regions(options.out / "average.regions.toml", x, markers, names)


if __name__ == "__main__":
    main()
