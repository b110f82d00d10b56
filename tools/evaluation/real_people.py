"""Figure 6: real footage without truth: what a blink moves besides the lids, and how still a still face is."""
import json

import numpy as np

from evaluation import metrics
from evaluation.commands import write_parameter_rig
from evaluation.report import LeftOut, Row, Section
from evaluation.shapes import ALL, is_brow, is_mouth

NEUTRAL = "390:414"  # the clip begins with a laugh; here the performer is at rest
# Landmarks by what they do.
SKULL = [10, 151, 9, 8, 168, 6, 197, 195, 127, 356, 234, 454, 33, 263]
MOUTH_AND_BROWS = [61, 291, 0, 17, 13, 14, 37, 267, 84, 314, 78, 308, 70, 63, 105, 66, 107, 300, 293, 334, 296, 336]
EYES = (((159, 145), (158, 153), (160, 144), (33, 133)), ((386, 374), (385, 380), (387, 373), (263, 362)))
# At 24 frames a second. Before and after a blink: five frames, from ten to six frames off its apex.
MEDIAN_HALF, NEAR, FAR = 36, 6, 10
# Parts of the distance between the outer eye corners (about 9 cm): as much may mouth and brows have moved from before a
# blink to after it, and vary in a second that counts as still.
SAME_PLACE, STILL, STILL_FRAMES = 0.012, 0.003, 24
# By how much a blink may change a parameter.
LIMIT = 0.05


def read_landmarks(path):
    rows = [json.loads(line)["landmarks"] for line in open(path)]
    if any(row is None for row in rows):
        raise LeftOut("the face is lost in some frames of franck.mp4")
    return np.array(rows, float)[:, :, :2]


def lid_opening(points):
    """Mean height of the three gaps of both eyes over the eyes' width."""
    def length(a, b):
        return np.linalg.norm(points[:, a] - points[:, b], axis=1)
    return np.mean([sum(length(*gap) for gap in gaps) / 3 / length(*corners) for *gaps, corners in EYES], axis=0)


def around(values, at):
    """Means of the frames before and after `at`."""
    return values[at - FAR:at - NEAR + 1].mean(0), values[at + NEAR:at + FAR + 1].mean(0)


def nothing_else_moved(face, at):
    before, after = around(face, at)
    return np.linalg.norm(before - after, axis=1).mean() < SAME_PLACE


def changes(values, moments):
    """Moments x parameters: at the moment, from just before."""
    return np.array([values[at] - around(values, at)[0] for at in moments])


def still_stretches(face, blinking):
    """First frames of the seconds without a blink in which mouth and brows hardly move; they do not overlap."""
    starts, at = [], 0
    while at + STILL_FRAMES <= len(face):
        window = slice(at, at + STILL_FRAMES)
        if not blinking[window].any() and face[window].std(0).mean() < STILL:
            starts.append(at)
            at += STILL_FRAMES
        else:
            at += 1
    return starts


def measure(context):
    section = Section("Real people: franck.mp4")
    video = context.commands.root / ".assets/footage/franck.mp4"
    if not video.exists():
        raise LeftOut("there is no .assets/footage/franck.mp4; tools/setup fetches it")
    landmarks = context.commands.track(video)
    rig = write_parameter_rig(context.commands.work / "real_rig.toml", ALL)
    poses = context.commands.retarget(landmarks, rig, NEUTRAL, context.profile)
    quiet = [s for s in ALL if is_mouth(s) or is_brow(s)]
    values = metrics.hold(np.stack([poses[s] for s in ALL], 1))
    mouth_and_brows = values[:, [ALL.index(s) for s in quiet]]

    points = read_landmarks(landmarks)[:len(values)]
    eyes_px = np.linalg.norm(points[:, 33] - points[:, 263], axis=1).mean()
    face = metrics.align(points, points[int(NEUTRAL.split(":")[0])], SKULL)[:, MOUTH_AND_BROWS] / eyes_px
    inside = range(FAR, len(points) - FAR)
    apexes = [at for at in metrics.blinks(lid_opening(points), MEDIAN_HALF) if at in inside]
    blinking = np.zeros(len(points), bool)
    for at in apexes:
        blinking[max(at - FAR, 0):at + FAR + 1] = True
    still_blinks = [at for at in apexes if nothing_else_moved(face, at)]
    others = [at for at in inside if not blinking[at - FAR:at + FAR + 1].any() and nothing_else_moved(face, at)]
    stretches = still_stretches(face, blinking)
    if not still_blinks or not others or not stretches:
        raise LeftOut(f"{len(still_blinks)} still blinks, {len(others)} comparable moments, {len(stretches)} still seconds")

    raw, elsewhere = np.abs(changes(mouth_and_brows, still_blinks)), np.abs(changes(mouth_and_brows, others))
    usual, most_elsewhere = elsewhere.mean(0), elsewhere.max(1)
    worst = np.unravel_index(raw.argmax(), raw.shape)
    corrected = raw.mean(0) - usual
    section.notes.append(
        f"{len(apexes)} blinks, by the landmarks' lid opening; in {len(still_blinks)} of them mouth and brow landmarks are "
        f"within 1 mm before and after. Change: at the apex, from the mean of 0.4 to 0.25 s before. Corrected: its mean less "
        f"what the same parameter does in {len(others)} comparable moments without a blink. {len(stretches)} still seconds.")
    section.rows.append(Row(f"blink moves {quiet[worst[1]]} at frame {still_blinks[worst[0]]}: the most of all", raw.max(),
                            ("<=", LIMIT)))
    section.rows.append(Row("the most of each blink, median", np.median(raw.max(1))))
    section.rows.append(Row("the most of a moment without a blink, median", np.median(most_elsewhere)))
    section.rows.append(Row("the same, 95 of 100 moments are below", np.percentile(most_elsewhere, 95)))
    section.rows.append(Row("part of these moments that is above the limit of a blink", (most_elsewhere > LIMIT).mean()))
    section.rows.append(Row(f"mean over blinks, worst parameter ({quiet[raw.mean(0).argmax()]})", raw.mean(0).max()))
    section.rows.append(Row(f"the same, corrected ({quiet[corrected.argmax()]})", corrected.max()))
    variances = np.array([values[at:at + STILL_FRAMES].var(0) for at in stretches])
    pooled = np.sqrt(variances.mean(0))
    section.rows.append(Row(f"standard deviation in still seconds, worst parameter ({ALL[pooled.argmax()]})", pooled.max(),
                            ("<=", 0.01), digits=4))
    section.rows.append(Row("the same, mean of all parameters", pooled.mean(), digits=4))
    return section
