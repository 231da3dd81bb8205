"""Reads files of `convert` with other people's readers and prints, as JSON, how far they are from the array in an .npz file.

Usage: read_radar_files.py FOLDER, which holds scan.npz, scan.rd3, scan.rad, scan.DT1, scan.HD, scan.sgy and scan.csv.
Differences are shares of the largest amplitude, after the one factor that counts leave open.
"""

import json
import sys
import warnings
from pathlib import Path

import numpy as np
import segyio
from impdar.lib import load

warnings.simplefilter("ignore")
folder = Path(sys.argv[1])
wanted = np.load(folder / "scan.npz")
samples, times = wanted["samples"], wanted["time_s"]
found = {}


def tell(name, data, step, **more):
    data = np.asarray(data, dtype=float)
    reference = samples if name != "dt1" else samples - samples[:, :100].mean(axis=1, keepdims=True)
    factor = float((data * reference).sum() / (data * data).sum()) if data.any() else 1.0
    difference = np.abs(factor * data - reference).max() / np.abs(samples).max()
    found[name] = {"shape": list(data.shape), "step": step, "factor": factor, "difference": float(difference), **more}


# ImpDAR has a sample in each row; of DT1 it takes the mean of the first 100 samples of each trace, and cuts to whole numbers.
rd3 = load.load("ramac", [str(folder / "scan.rd3")])[0]
tell("rd3", rd3.data.T, float(rd3.dt))
dt1 = load.load("pe", [str(folder / "scan.DT1")])[0]
tell("dt1", dt1.data.T, float(dt1.dt))
with segyio.open(str(folder / "scan.sgy"), ignore_geometry=True) as file:
    tell("sgy", file.trace.raw[:], file.bin[segyio.BinField.Interval] * 1e-12,
         x=[h[segyio.TraceField.GroupX] / 1000 for h in file.header], text=bytes(file.text[0])[:30].decode())
table = np.genfromtxt(folder / "scan.csv", delimiter=",", names=True)
columns = np.array([table[name] for name in table.dtype.names])
tell("csv", columns[1:], float(np.diff(columns[0] * 1e-9).mean()), first=float(columns[0][0] * 1e-9))
found["npz"] = {"shape": list(samples.shape), "step": float(np.diff(times).mean()), "first": float(times[0])}
json.dump(found, sys.stdout)
