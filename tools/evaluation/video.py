"""Figure 4: expression from video: tracked landmarks to 51 shapes, on two rendered people with known weights."""
import numpy as np

from evaluation import metrics
from evaluation.commands import write_parameter_rig
from evaluation.report import Row, Section

NEUTRAL = (0, 60)
# Shapes (by how their names begin) and the least correlation of each; the worst of sides and people counts.
LIMITS = {"jawOpen": 0.96, "mouthSmile": 0.96, "eyeBlink": 0.92, "browInnerUp": 0.9, "mouthPucker": 0.85, "eyeLook": 0.8}
# facts/retargeting.md: the plain paper, multiquadric on all poses in regions, the best mixture.
COLUMNS = ("paper", "regions", "best mixture")
MEANS = {"correlation": (".30", ".81", ".85"), "mean abs. error": (".136", ".058", ".055")}
MIXTURE = {"jawOpen": ".97", "mouthSmile": ".97", "eyeBlink": ".92", "mouthPucker": ".78-.95", "brow": ".70-.97",
           "eyeLook": ".05-.44"}


def mixture(shape):
    return next((text for start, text in MIXTURE.items() if shape.startswith(start)), "")


def people(context, profile):
    """For A and B: names of the shapes, what we give, truth; frames after the neutral."""
    commands, out = context.commands, {}
    for person in "AB":
        shapes, truth = context.data.truth(person)
        rig = write_parameter_rig(commands.work / "video_rig.toml", shapes)
        landmarks = commands.track(context.data.path(f"synth/{person}/video.mp4"))
        poses = commands.retarget(landmarks, rig, f"{NEUTRAL[0]}:{NEUTRAL[1]}", profile)
        ours = metrics.hold(np.stack([poses[s] for s in shapes], 1))
        frames = slice(NEUTRAL[1], min(len(ours), len(truth)))
        out[person] = shapes, ours[frames], truth[frames]
    return out


def scores(measured):
    """person -> (correlation by active shape, error by active shape)."""
    out = {}
    for person, (shapes, ours, truth) in measured.items():
        active = metrics.active(truth)
        correlation, error = metrics.correlations(ours, truth), metrics.absolute_errors(ours, truth)
        out[person] = ({s: c for s, c, a in zip(shapes, correlation, active) if a},
                       {s: e for s, e, a in zip(shapes, error, active) if a})
    return out


def measure(context):
    section = Section("Expression from video", baselines=COLUMNS)
    section.notes.append("People A and B, neutral from frames 0 to 59; shapes whose true weight exceeds 0.25 in the clip. "
                         "For named shapes, the worst of both sides and both people. Baselines: facts/retargeting.md.")
    results = scores(people(context, context.profile))
    for person, (correlation, error) in results.items():
        section.rows.append(Row(f"{person}: correlation, mean of {len(correlation)} shapes",
                                sum(correlation.values()) / len(correlation), (">=", 0.86), MEANS["correlation"]))
        section.rows.append(Row(f"{person}: mean abs. error", sum(error.values()) / len(error), ("<=", 0.052),
                                MEANS["mean abs. error"]))
    for start, limit in LIMITS.items():
        found = [c for correlation, _ in results.values() for s, c in correlation.items() if s.startswith(start)]
        if not found:
            section.left_out.append(f"{start}: neither clip shows it")
            continue
        mean = sum(found) / len(found)
        section.rows.append(Row(f"{start}: correlation, worst of {len(found)} (mean {mean:.2f})", min(found),
                                (">=", limit), ("", "", mixture(start))))
    shapes = sorted({s for correlation, _ in results.values() for s in correlation})
    section.details.append(["shape", "A corr.", "A error", "B corr.", "B error", "best mixture, corr."])
    for shape in shapes:
        cells = [shape]
        for correlation, error in results.values():
            cells += [f"{correlation[shape]:.2f}", f"{error[shape]:.3f}"] if shape in correlation else ["", ""]
        section.details.append(cells + [mixture(shape)])
    return section
