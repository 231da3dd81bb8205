"""Processes the traces of a JSON file with NumPy and SciPy and prints the results as JSON, by name.

Usage: process_scipy.py FILE

FILE holds `time_step` (s) and `traces` (equal lengths); the parameters of each case are those of tests/process_scipy.rs.
"""

import json
import sys

import numpy as np
from scipy import ndimage, signal

with open(sys.argv[1]) as file:
    given = json.load(file)
dt, lines = given["time_step"], np.array(given["traces"])
rate = 1 / dt
results = {}


def odd(window):
    return 2 * round(window / dt / 2) + 1


def mirrored_envelope(x):
    padded = np.concatenate([x, x[..., ::-1]], axis=-1)
    return np.abs(signal.hilbert(padded, axis=-1))[..., : x.shape[-1]]


results["mean"] = lines - lines.mean(axis=1, keepdims=True)
results["dewow"] = lines - ndimage.uniform_filter1d(lines, odd(3e-9), axis=1)
results["dewow median"] = lines - ndimage.median_filter(lines, size=(1, odd(3e-9)))
for kind, corners in {"bandpass": [0.3e9, 1.5e9], "highpass": 0.4e9, "lowpass": 2.1e9}.items():
    for order in (1, 2, 3, 4, 7):
        sections = signal.butter(order, corners, btype=kind, fs=rate, output="sos")
        results[f"{kind} {order}"] = signal.sosfiltfilt(sections, lines, axis=1)
results["background"] = lines - lines.mean(axis=0)
results["moving background"] = lines - ndimage.uniform_filter1d(lines, 5, axis=0)
median = np.median(lines, axis=0)
lack = np.array([1 - np.corrcoef(line, median)[0, 1] for line in lines])
kept = lack <= max(4 * np.median(lack), 1e-3)
results["stack"] = lines[kept].mean(axis=0)[None]
results["dropped"] = np.flatnonzero(~kept)[None]
times = 1e9 * np.maximum(np.arange(lines.shape[1]) * dt, dt)
results["sec"] = lines * np.exp(0.15 * times) * times**1.2
level = np.sqrt(ndimage.uniform_filter1d(lines**2, odd(4e-9), axis=1))
results["agc"] = lines / np.maximum(level, 1e-6 * level.max(axis=1, keepdims=True))
results["envelope"] = mirrored_envelope(lines)
length = 1 << int(np.ceil(np.log2(4 * lines.shape[1])))
results["spectrum"] = np.abs(np.fft.rfft(lines[0], length))[None] * dt
window = odd(4e-9)
padded = 1 << int(np.ceil(np.log2(4 * window)))
_, _, transform = signal.stft(
    lines[0], fs=rate, window="hann", nperseg=window, noverlap=window - 1, nfft=padded, boundary="zeros", scaling="spectrum"
)
results["short-time spectrum"] = np.abs(transform).T[: lines.shape[1]]

json.dump({name: value.tolist() for name, value in results.items()}, sys.stdout)
