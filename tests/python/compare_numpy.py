"""Compares the radargrams and traces of a JSON file with NumPy and SciPy and prints the metrics as JSON.

Usage: compare_numpy.py FILE

FILE holds `a` and `b`, each a list of traces of equal lengths, and `band`, the half width of the time warping in samples.
The structural similarity is written out after Wang et al. 2004; where scikit-image is installed it has to give the same.
"""

import json
import sys

import numpy as np
from scipy import ndimage, signal

with open(sys.argv[1]) as file:
    given = json.load(file)
a, b, band = np.array(given["a"]), np.array(given["b"]), given["band"]


def structural_similarity(x, y, span, side=7):
    mean = lambda v: ndimage.uniform_filter(v, side)
    sample = side * side / (side * side - 1)
    ux, uy = mean(x), mean(y)
    vx, vy = sample * (mean(x * x) - ux * ux), sample * (mean(y * y) - uy * uy)
    vxy = sample * (mean(x * y) - ux * uy)
    c1, c2 = (0.01 * span) ** 2, (0.03 * span) ** 2
    s = (2 * ux * uy + c1) * (2 * vxy + c2) / ((ux**2 + uy**2 + c1) * (vx + vy + c2))
    edge = side // 2
    return s[edge:-edge, edge:-edge].mean()


span = a.max() - a.min()
similarity = structural_similarity(a, b, span)
try:
    from skimage.metrics import structural_similarity as by_skimage
except ImportError:
    by_skimage = None
if by_skimage is not None:
    assert abs(by_skimage(a, b, data_range=span) - similarity) < 1e-12

x, y = a[0], b[0]
cost = np.full((len(x) + 1, len(y) + 1), np.inf)
cost[0, 0] = 0
for i in range(len(x)):
    for j in range(max(0, i - band), min(len(y), i + band + 1)):
        cost[i + 1, j + 1] = abs(x[i] - y[j]) + min(cost[i, j + 1], cost[i + 1, j], cost[i, j])


def pearson(x, y):
    return np.corrcoef(x, y)[0, 1]


def mirrored_envelope(x):
    return np.abs(signal.hilbert(np.concatenate([x, x[::-1]])))[: len(x)]


correlation = signal.correlate(y, x) / (np.linalg.norm(x) * np.linalg.norm(y))
json.dump(
    {
        "structural similarity": similarity,
        "time warp": cost[-1, -1] / len(x),
        "correlation": float(x @ y / (np.linalg.norm(x) * np.linalg.norm(y))),
        "lag in samples": float(np.argmax(np.abs(correlation)) - (len(x) - 1)),
        "rmse": float(np.sqrt(np.mean((y - x) ** 2))),
        "relative l2": float(np.linalg.norm(y - x) / np.linalg.norm(x)),
        "envelope correlation": pearson(mirrored_envelope(x), mirrored_envelope(y)),
    },
    sys.stdout,
)
