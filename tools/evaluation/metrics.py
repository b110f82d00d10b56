"""Numbers that say how near one motion is to another. Frames are rows throughout."""
import numpy as np


def correlations(ours, truth):
    """Pearson's correlation of each column; 0 where one of the two does not move."""
    a, b = ours - ours.mean(0), truth - truth.mean(0)
    size = np.sqrt((a * a).sum(0) * (b * b).sum(0))
    return np.where(size > 1e-9, (a * b).sum(0) / np.maximum(size, 1e-9), 0.0)


def absolute_errors(ours, truth):
    """Mean absolute error of each column."""
    return np.abs(ours - truth).mean(0)


def active(truth, threshold=0.25):
    """Which columns exceed the threshold somewhere: the shapes that a clip shows at all."""
    return truth.max(0) > threshold


def motion_error(ours, truth):
    """Mean length of the error over the mean length of the true motion; both frames x points x 3."""
    return np.linalg.norm(ours - truth, axis=2).mean() / np.linalg.norm(truth, axis=2).mean()


def hold(values):
    """Frames without a face (not a number) keep the values of the frame before, as a display does."""
    out = values.copy()
    for i in range(len(out)):
        if np.isnan(out[i]).any():
            out[i] = out[i - 1] if i > 0 else 0.0
    return out


def running_median(values, half):
    """Median of each value's neighbours up to `half` before and after it."""
    padded = np.pad(values, half, mode="edge")
    return np.median(np.lib.stride_tricks.sliding_window_view(padded, 2 * half + 1), axis=1)


def blinks(opening, half, share=0.6):
    """Frames at which the lids are nearest, one for each time that their opening falls below `share` of its
    running median over `half` frames before and after."""
    closed = opening < share * running_median(opening, half)
    apexes, start = [], None
    for i, is_closed in enumerate(np.append(closed, False)):
        if is_closed and start is None:
            start = i
        elif not is_closed and start is not None:
            apexes.append(start + int(np.argmin(opening[start:i])))
            start = None
    return apexes


def align(points, reference, index):
    """Frames x points x 2, moved, turned and scaled so that the points of `index` lie as in the reference (points x 2)
    as nearly as possible: what is left is the face's own motion."""
    def flat(p):
        return p[..., 0] + 1j * p[..., 1]
    p, r = flat(points), flat(reference)
    centre = p[:, index].mean(1, keepdims=True)
    goal = r[index].mean()
    moved, wanted = p[:, index] - centre, r[index] - goal
    turn = (moved.conj() @ wanted) / (np.abs(moved) ** 2).sum(1)
    out = (p - centre) * turn[:, None] + goal
    return np.stack([out.real, out.imag], axis=2)
