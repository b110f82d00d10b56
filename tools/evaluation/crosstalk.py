"""Figure 5: cross-talk on stills of which every mouth weight is 0: what must not move when lids or brows do."""
import json

import numpy as np

from evaluation import metrics
from evaluation.commands import write_parameter_rig
from evaluation.report import Row, Section
from evaluation.shapes import ALL, is_brow, is_mouth

# Each still is shown this long, so that the landmark filter comes to rest; its last frame counts.
FRAMES_A_STILL, RATE_HZ = 30, 30
SIZE = (640, 480)
BASELINE = ("1.0", ".27", ".12", ".11-.13")
COLUMNS = ("least squares", "paper", "regions", "best")


def write_stills(path, stills):
    with open(path, "w") as out:
        frame = 0
        for still in stills:
            landmarks = json.dumps(still["landmarks"])
            for _ in range(FRAMES_A_STILL):
                out.write(f'{{"frame":{frame},"t_us":{frame * 1000000 // RATE_HZ},"state":"tracking","presence":1,'
                          f'"width":{SIZE[0]},"height":{SIZE[1]},"landmarks":{landmarks}}}\n')
                frame += 1
    return path


def measure(context):
    section = Section("Cross-talk", baselines=COLUMNS)
    section.notes.append("Stills of A and B, neutral from their neutral stills; largest change of a parameter from its mean "
                         "over the neutral stills. Baselines: mouth moved by a blink, worst (facts/retargeting.md).")
    stills = context.data.json_lines("average/crosstalk_poses.jsonl.gz")
    rig = write_parameter_rig(context.commands.work / "crosstalk_rig.toml", ALL)
    worst = {}
    for person in sorted({s["identity"] for s in stills}):
        own = [s for s in stills if s["identity"] == person]
        rest = [s for s in own if s["id"].startswith("neutral")]
        source = write_stills(context.commands.work / f"crosstalk_{person}.jsonl", rest + [s for s in own if s not in rest])
        poses = context.commands.retarget(source, rig, f"0:{len(rest) * FRAMES_A_STILL}", context.profile)
        values = metrics.hold(np.stack([poses[s] for s in ALL], 1))[FRAMES_A_STILL - 1::FRAMES_A_STILL]
        change = np.abs(values - values[:len(rest)].mean(0))
        for still, row in zip(rest + [s for s in own if s not in rest], change):
            kind = "blink" if still["id"].startswith("blink") else "brow" if still["id"].startswith("brow") else ""
            for shape, moved in zip(ALL, row):
                part = "mouth" if is_mouth(shape) else "brow" if is_brow(shape) else ""
                key = kind, part
                if moved >= worst.get(key, (0, ""))[0]:
                    worst[key] = moved, f"{shape}, {person}, {still['id']}"
    for key, limit, baselines in ((("blink", "mouth"), 0.05, BASELINE), (("blink", "brow"), 0.05, ()),
                                  (("brow", "mouth"), 0.08, ())):
        moved, where = worst.get(key, (float("nan"), "no such still"))
        section.rows.append(Row(f"{key[0]} moves {key[1]} ({where})", moved, ("<=", limit), baselines))
    return section
