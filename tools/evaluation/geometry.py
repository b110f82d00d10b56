"""Figure 2: geometry mapping. A character's face is the performer's, bent by a known smooth warp of space; so is every
true motion, and what `facewire retarget` makes of the performer's markers can be compared with it."""
import numpy as np

from evaluation import metrics
from evaluation.commands import write_markers
from evaluation.report import Row, Section

NEUTRAL_FRAMES = 10
# Of the 68 markers those that a rig's 48 bones follow: every other one of the jaw line, brows, some of the nose, lids, outer
# lips.
BONES = [*range(0, 17, 2), *range(17, 27), 27, 30, 31, 33, 35, *range(36, 60)]
MOUTH, CHIN = slice(48, 60), 8


def bump(points, centre, widths):
    """1 at the centre, falling smoothly to 0 a few widths away."""
    return np.exp(-0.5 * (((points - centre) / widths) ** 2).sum(-1, keepdims=True))


def anisotropic_scale(points, _):
    return points * [1.3, 0.8, 1.15]


def wide_mouth(points, neutral):
    """Half again as wide at the mouth."""
    centre = neutral[MOUTH].mean(0)
    wider = (points - centre) * [0.5, 0, 0]
    return points + bump(points, centre, [4, 2, 4]) * wider


def big_chin(points, neutral):
    """A stylised face: the chin twice as heavy and drawn down, brows low, everything a little larger."""
    chin, brows = neutral[CHIN], neutral[17:27].mean(0)
    heavy = (points - chin) * [0.8, 0.5, 0.4] + [0, -2.5, 0.5]
    low = np.array([0, -0.8, 0.2])
    return 1.1 * (points + bump(points, chin, [4, 3, 4]) * heavy + bump(points, brows, [6, 1.5, 4]) * low)


WARPS = {"anisotropic scale": anisotropic_scale, "mouth half again as wide": wide_mouth, "big chin": big_chin}


def write_rig(path, names, rest):
    """A bone for each marker, free to go nearly anywhere."""
    parts = ['name = "warped"\n']
    for name, (x, y, z) in zip(names, rest):
        axes = "\n".join(f"{axis} = {{ min = -20, max = 20 }}" for axis in "xyz")
        parts.append(f'[[bone]]\nname = "{name}"\nmarker = "{name}"\nrest_cm = [{x:.4f}, {y:.4f}, {z:.4f}]\n{axes}\n')
    path.write_text("\n".join(parts))
    return path


def measure(context):
    section = Section("Geometry mapping", baselines=("copying displacements", "facts, real proportions"))
    section.notes.append(f"Person A's markers at 100 frames a second drive {len(BONES)} bones of a character whose face is A's, "
                         "bent by a known warp. Mean error over mean motion, over all frames and bones.")
    names, points = context.data.pair_markers("A")
    neutral = context.data.neutral_markers("A")
    take = np.concatenate([np.repeat(neutral[None], NEUTRAL_FRAMES, 0), points])
    source = write_markers(context.commands.work / "geometry.csv", names, take, 100)
    bone_names = [names[i] for i in BONES]
    copied = (points - neutral)[:, BONES]
    for name, warp in WARPS.items():
        rest = warp(neutral, neutral)
        truth = (warp(points, neutral) - rest)[:, BONES]
        rig = write_rig(context.commands.work / "geometry_rig.toml", bone_names, rest[BONES])
        poses = context.commands.retarget(source, rig, f"0:{NEUTRAL_FRAMES}")
        ours = np.stack([[poses[f"{bone}.{axis}"] for axis in "xyz"] for bone in bone_names], 0)
        ours = ours.transpose(2, 0, 1)[NEUTRAL_FRAMES:]
        error, copying = metrics.motion_error(ours, truth), metrics.motion_error(copied, truth)
        section.rows.append(Row(f"{name}: error / motion", error, ("<=", 0.15), (f"{copying:.3f}", ".16-.42")))
        section.rows.append(Row(f"{name}: error / error of copying", error / copying, ("<=", 1)))
    said = context.commands.run(context.commands.build / "tests/core/retarget/retarget_test", "--gtest_filter=SafeBones*")
    section.rows.append(Row("property tests: no bone outside its limits", int("[  PASSED  ]" in said), (">=", 1), digits=0))
    return section
